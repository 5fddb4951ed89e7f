# jet-depth: the depth of the cut against the speed of the jet, its traverse and its stand-off; each is a patch of jet-tofu-5.

.PHONY: jet-depth
jet-depth: build/jet-depth/report.html ## depth of cut against speed, traverse and stand-off

build/jet-depth/speed-3.mcap: pipelines/jet-tofu-5/scene.json pipelines/jet-depth/speed-3.patch.json $(BIN)/jetsph always
	$(RERUN) $(BIN)/jetsph run pipelines/jet-tofu-5/scene.json --patch pipelines/jet-depth/speed-3.patch.json \
	  --out $@ $(MACHINE)

build/jet-depth/speed-8.mcap: pipelines/jet-tofu-5/scene.json pipelines/jet-depth/speed-8.patch.json $(BIN)/jetsph always
	$(RERUN) $(BIN)/jetsph run pipelines/jet-tofu-5/scene.json --patch pipelines/jet-depth/speed-8.patch.json \
	  --out $@ $(MACHINE)

build/jet-depth/speed-12.mcap: pipelines/jet-tofu-5/scene.json pipelines/jet-depth/speed-12.patch.json $(BIN)/jetsph always
	$(RERUN) $(BIN)/jetsph run pipelines/jet-tofu-5/scene.json --patch pipelines/jet-depth/speed-12.patch.json \
	  --out $@ $(MACHINE)

build/jet-depth/speed-20.mcap: pipelines/jet-tofu-5/scene.json pipelines/jet-depth/speed-20.patch.json $(BIN)/jetsph always
	$(RERUN) $(BIN)/jetsph run pipelines/jet-tofu-5/scene.json --patch pipelines/jet-depth/speed-20.patch.json \
	  --out $@ $(MACHINE)

build/jet-depth/traverse.mcap: pipelines/jet-tofu-5/scene.json pipelines/jet-depth/traverse.patch.json $(BIN)/jetsph always
	$(RERUN) $(BIN)/jetsph run pipelines/jet-tofu-5/scene.json --patch pipelines/jet-depth/traverse.patch.json \
	  --out $@ $(MACHINE)

build/jet-depth/stand-off-30.mcap: pipelines/jet-tofu-5/scene.json pipelines/jet-depth/stand-off-30.patch.json $(BIN)/jetsph always
	$(RERUN) $(BIN)/jetsph run pipelines/jet-tofu-5/scene.json --patch pipelines/jet-depth/stand-off-30.patch.json \
	  --out $@ $(MACHINE)

build/jet-depth/report.html: build/jet-depth/speed-3.mcap \
  build/jet-depth/speed-8.mcap \
  build/jet-depth/speed-12.mcap \
  build/jet-depth/speed-20.mcap \
  build/jet-depth/traverse.mcap \
  build/jet-depth/stand-off-30.mcap $(BIN)/report always
	$(RERUN) $(BIN)/report jet --study jet-depth --out $@ \
	  --frames speed-3=build/jet-depth/speed-3.mcap \
	  --frames speed-8=build/jet-depth/speed-8.mcap \
	  --frames speed-12=build/jet-depth/speed-12.mcap \
	  --frames speed-20=build/jet-depth/speed-20.mcap \
	  --frames traverse=build/jet-depth/traverse.mcap \
	  --frames stand-off-30=build/jet-depth/stand-off-30.mcap

.PRECIOUS: build/jet-depth/speed-3.mcap build/jet-depth/speed-8.mcap build/jet-depth/speed-12.mcap build/jet-depth/speed-20.mcap build/jet-depth/traverse.mcap build/jet-depth/stand-off-30.mcap build/jet-depth/report.html
