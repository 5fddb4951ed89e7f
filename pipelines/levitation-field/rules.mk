# levitation-field: a molten drop above four loops, beside the exact solution.

.PHONY: levitation-field
levitation-field: build/levitation-field/report.html ## eddy currents, lift and heat of a levitated drop against the exact solution

build/levitation-field/drop.mcap: pipelines/levitation-field/scene.json $(BIN)/emfield always
	$(RERUN) $(BIN)/emfield run pipelines/levitation-field/scene.json --out $@ $(MACHINE)

build/levitation-field/exact.json: pipelines/levitation-field/scene.json $(BIN)/exact always
	$(RERUN) $(BIN)/exact pipelines/levitation-field/scene.json --out $@

build/levitation-field/report.html: build/levitation-field/drop.mcap build/levitation-field/exact.json $(BIN)/report always
	$(RERUN) $(BIN)/report field --study levitation-field --out $@ \
	  --fields drop=build/levitation-field/drop.mcap --exact drop=build/levitation-field/exact.json

.PRECIOUS: build/levitation-field/drop.mcap build/levitation-field/exact.json build/levitation-field/report.html
