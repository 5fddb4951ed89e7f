# drop-oscillation: a water drop of 35 um swings about the sphere.

.PHONY: drop-oscillation
drop-oscillation: build/drop-oscillation/report.html ## a drop that oscillates about the sphere: radii, modes and a moving picture

build/drop-oscillation/drop.mcap: pipelines/drop-oscillation/scene.json $(BIN)/emfield always
	$(RERUN) $(BIN)/emfield run pipelines/drop-oscillation/scene.json --out $@ $(MACHINE)

build/drop-oscillation/report.html: build/drop-oscillation/drop.mcap $(BIN)/report always
	$(RERUN) $(BIN)/report drop --study drop-oscillation --out $@ --drop water=build/drop-oscillation/drop.mcap

.PRECIOUS: build/drop-oscillation/drop.mcap build/drop-oscillation/report.html
