# levitation: a molten drop held up by four loops, at rest and released 2 % stretched.

.PHONY: levitation
levitation: build/levitation/report.html ## a molten drop in the field of four loops: current that holds it, shape at rest, three periods of its motion

build/levitation/rest.mcap: pipelines/levitation/scene.json pipelines/levitation/rest.patch.json $(BIN)/emfield always
	$(RERUN) $(BIN)/emfield run pipelines/levitation/scene.json --patch pipelines/levitation/rest.patch.json --out $@ $(MACHINE)

build/levitation/drop.mcap: pipelines/levitation/scene.json $(BIN)/emfield always
	$(RERUN) $(BIN)/emfield run pipelines/levitation/scene.json --out $@ $(MACHINE)

build/levitation/report.html: build/levitation/rest.mcap build/levitation/drop.mcap $(call certificate,levitation) $(BIN)/report always
	$(RERUN) $(BIN)/report drop --study levitation --out $@ --drop rest=build/levitation/rest.mcap \
	  --drop released=build/levitation/drop.mcap $(call certified,levitation)

.PRECIOUS: build/levitation/rest.mcap build/levitation/drop.mcap build/levitation/report.html
