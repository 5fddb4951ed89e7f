# jet-tofu-50: the solid of jet-tofu-5 under a jet of 50 m/s.

.PHONY: jet-tofu-50
jet-tofu-50: build/jet-tofu-50/report.html ## a jet of 50 m/s shatters a soft solid, with its film

build/jet-tofu-50/jet.mcap: pipelines/jet-tofu-5/scene.json pipelines/jet-tofu-50/jet.patch.json $(BIN)/jetsph always
	$(RERUN) $(BIN)/jetsph run pipelines/jet-tofu-5/scene.json --patch pipelines/jet-tofu-50/jet.patch.json \
	  --out $@ $(MACHINE)

build/jet-tofu-50/report.html: build/jet-tofu-50/jet.mcap $(BIN)/report always
	$(RERUN) $(BIN)/report jet --study jet-tofu-50 --out $@ --frames 50=build/jet-tofu-50/jet.mcap

.PRECIOUS: build/jet-tofu-50/jet.mcap build/jet-tofu-50/report.html
