# drop-collision: two drops meet off their centres, become one, and part again.

.PHONY: drop-collision
drop-collision: build/drop-collision/report.html ## two drops meet off their centres, become one and part again: a moving picture

build/drop-collision/drops.mcap: pipelines/drop-collision/scene.json $(BIN)/emfield always
	$(RERUN) $(BIN)/emfield run pipelines/drop-collision/scene.json --out $@ $(MACHINE)

build/drop-collision/report.html: build/drop-collision/drops.mcap $(BIN)/report always
	$(RERUN) $(BIN)/report drop --study drop-collision --out $@ --drop drops=build/drop-collision/drops.mcap

.PRECIOUS: build/drop-collision/drops.mcap build/drop-collision/report.html
