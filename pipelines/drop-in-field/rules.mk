# drop-in-field: shapes of a water drop at rest in uniform fields of 3, 5 and 6 MV/m, found without a march.

.PHONY: drop-in-field
drop-in-field: build/drop-in-field/report.html ## shapes of a water drop at rest in three fields, and the greatest possible field

build/drop-in-field/5.mcap: pipelines/drop-in-field/scene.json $(BIN)/emfield always
	$(RERUN) $(BIN)/emfield run pipelines/drop-in-field/scene.json --out $@ $(MACHINE)

build/drop-in-field/%.mcap: pipelines/drop-in-field/scene.json pipelines/drop-in-field/%.patch.json $(BIN)/emfield always
	$(RERUN) $(BIN)/emfield run pipelines/drop-in-field/scene.json --patch pipelines/drop-in-field/$*.patch.json --out $@ $(MACHINE)

build/drop-in-field/report.html: build/drop-in-field/3.mcap build/drop-in-field/5.mcap build/drop-in-field/6.mcap $(BIN)/report always
	$(RERUN) $(BIN)/report drop --study drop-in-field --out $@ --drop 3MV/m=build/drop-in-field/3.mcap \
	  --drop 5MV/m=build/drop-in-field/5.mcap --drop 6MV/m=build/drop-in-field/6.mcap

.PRECIOUS: build/drop-in-field/%.mcap build/drop-in-field/3.mcap build/drop-in-field/5.mcap build/drop-in-field/6.mcap build/drop-in-field/report.html
