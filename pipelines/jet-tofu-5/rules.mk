# jet-tofu-5: a jet of water of 5 m/s cuts a soft solid, in the plane, at the spacings of the source and at half of them, there also
# with a strain that counts over the particles of the source.

.PHONY: jet-tofu-5
jet-tofu-5: build/jet-tofu-5/report.html ## a jet of 5 m/s cuts a soft solid, with its film

build/jet-tofu-5/jet.mcap: pipelines/jet-tofu-5/scene.json $(BIN)/jetsph always
	$(RERUN) $(BIN)/jetsph run pipelines/jet-tofu-5/scene.json --out $@ $(MACHINE)

build/jet-tofu-5/half.mcap: pipelines/jet-tofu-5/scene.json pipelines/jet-tofu-5/half.patch.json $(BIN)/jetsph always
	$(RERUN) $(BIN)/jetsph run pipelines/jet-tofu-5/scene.json --patch pipelines/jet-tofu-5/half.patch.json \
	  --out $@ $(MACHINE)

build/jet-tofu-5/length.mcap: pipelines/jet-tofu-5/scene.json pipelines/jet-tofu-5/length.patch.json $(BIN)/jetsph always
	$(RERUN) $(BIN)/jetsph run pipelines/jet-tofu-5/scene.json --patch pipelines/jet-tofu-5/length.patch.json \
	  --out $@ $(MACHINE)

build/jet-tofu-5/report.html: build/jet-tofu-5/half.mcap build/jet-tofu-5/jet.mcap build/jet-tofu-5/length.mcap $(call certificate,jet-tofu-5) $(BIN)/report always
	$(RERUN) $(BIN)/report jet --study jet-tofu-5 --out $@ --frames half=build/jet-tofu-5/half.mcap \
	  --frames source=build/jet-tofu-5/jet.mcap --frames length=build/jet-tofu-5/length.mcap $(call certified,jet-tofu-5)

.PRECIOUS: build/jet-tofu-5/jet.mcap build/jet-tofu-5/half.mcap build/jet-tofu-5/length.mcap build/jet-tofu-5/report.html
