# dielectric-sphere: a dielectric sphere in a uniform field, beside the exact solution.

.PHONY: dielectric-sphere
dielectric-sphere: build/dielectric-sphere/report.html ## potential, field and traction of a dielectric sphere against the exact solution

build/dielectric-sphere/sphere.mcap: pipelines/dielectric-sphere/scene.json $(BIN)/emfield
	$(RERUN) $@ $^ -- $(BIN)/emfield run pipelines/dielectric-sphere/scene.json --out $@ $(MACHINE)

build/dielectric-sphere/exact.json: pipelines/dielectric-sphere/scene.json $(BIN)/exact
	$(RERUN) $@ $^ -- $(BIN)/exact pipelines/dielectric-sphere/scene.json --out $@

build/dielectric-sphere/report.html: build/dielectric-sphere/sphere.mcap build/dielectric-sphere/exact.json $(BIN)/report
	$(RERUN) $@ $^ -- $(BIN)/report field --study dielectric-sphere --out $@ \
	  --fields sphere=build/dielectric-sphere/sphere.mcap --exact sphere=build/dielectric-sphere/exact.json
