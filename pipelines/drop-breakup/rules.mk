# drop-breakup: a drop in a field beyond its limit grows pointed ends that shed liquid.

.PHONY: drop-breakup
drop-breakup: build/drop-breakup/report.html ## a drop in a field beyond its limit, with pointed ends: a moving picture

build/drop-breakup/drop.mcap: pipelines/drop-breakup/scene.json $(BIN)/emfield always
	$(RERUN) $(BIN)/emfield run pipelines/drop-breakup/scene.json --out $@ $(MACHINE)

build/drop-breakup/report.html: build/drop-breakup/drop.mcap $(BIN)/report always
	$(RERUN) $(BIN)/report drop --study drop-breakup --out $@ --drop drop=build/drop-breakup/drop.mcap

.PRECIOUS: build/drop-breakup/drop.mcap build/drop-breakup/report.html
