# jet-tofu-50-backflow: jet-tofu-50, and the same with the water taken away that flows back out of the cut.

.PHONY: jet-tofu-50-backflow
jet-tofu-50-backflow: build/jet-tofu-50-backflow/report.html ## a jet of 50 m/s with and without its backflow (plane only)

build/jet-tofu-50-backflow/jet.mcap: pipelines/jet-tofu-5/scene.json pipelines/jet-tofu-50/jet.patch.json \
  pipelines/jet-tofu-50-backflow/backflow.patch.json $(BIN)/jetsph always
	$(RERUN) $(BIN)/jetsph run pipelines/jet-tofu-5/scene.json --patch pipelines/jet-tofu-50/jet.patch.json \
	  --patch pipelines/jet-tofu-50-backflow/backflow.patch.json --out $@ $(MACHINE)

build/jet-tofu-50-backflow/report.html: build/jet-tofu-50/jet.mcap build/jet-tofu-50-backflow/jet.mcap $(BIN)/report always
	$(RERUN) $(BIN)/report jet --study jet-tofu-50-backflow --out $@ \
	  --frames with=build/jet-tofu-50/jet.mcap --frames without=build/jet-tofu-50-backflow/jet.mcap

.PRECIOUS: build/jet-tofu-50-backflow/jet.mcap build/jet-tofu-50-backflow/report.html
