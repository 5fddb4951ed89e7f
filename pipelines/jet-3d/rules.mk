# jet-3d: a round jet of 20 m/s on a soft block, in space.

.PHONY: jet-3d
jet-3d: build/jet-3d/report.html ## a round jet on a soft block in space, with its film

build/jet-3d/jet.mcap: pipelines/jet-3d/scene.json $(BIN)/jetsph always
	$(RERUN) $(BIN)/jetsph run pipelines/jet-3d/scene.json --out $@ $(MACHINE)

build/jet-3d/report.html: build/jet-3d/jet.mcap $(BIN)/report always
	$(RERUN) $(BIN)/report jet --study jet-3d --out $@ --frames 20=build/jet-3d/jet.mcap

.PRECIOUS: build/jet-3d/jet.mcap build/jet-3d/report.html
