# dielectric-sphere: a dielectric sphere in a uniform field, beside the exact solution.

.PHONY: dielectric-sphere
dielectric-sphere: build/dielectric-sphere/report.html ## potential, field and traction of a dielectric sphere against the exact solution

build/dielectric-sphere/sphere.mcap: pipelines/dielectric-sphere/scene.json $(BIN)/emfield always
	$(RERUN) $(BIN)/emfield run pipelines/dielectric-sphere/scene.json --out $@ $(MACHINE)

build/dielectric-sphere/exact.json: pipelines/dielectric-sphere/scene.json $(BIN)/exact always
	$(RERUN) $(BIN)/exact pipelines/dielectric-sphere/scene.json --out $@

build/dielectric-sphere/report.html: build/dielectric-sphere/sphere.mcap build/dielectric-sphere/exact.json $(BIN)/report always
	$(RERUN) $(BIN)/report field --study dielectric-sphere --out $@ \
	  --fields sphere=build/dielectric-sphere/sphere.mcap --exact sphere=build/dielectric-sphere/exact.json

.PRECIOUS: build/dielectric-sphere/sphere.mcap build/dielectric-sphere/exact.json build/dielectric-sphere/report.html
