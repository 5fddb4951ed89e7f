# tungsten-200a: the free-burning arc between a tungsten rod and a copper plate in argon.

.PHONY: tungsten-200a
tungsten-200a: build/tungsten-200a/report.html ## tungsten arc of 200 A in argon against published bands, with its report

build/tungsten-200a/arc.mcap: pipelines/tungsten-200a/arc.json build/gases/argon.mcap $(BIN)/arcfvm always
	$(RERUN) $(BIN)/arcfvm run pipelines/tungsten-200a/arc.json \
	  --input gas=build/gases/argon.mcap --out $@ $(MACHINE)

build/tungsten-200a/report.html: build/tungsten-200a/arc.mcap pipelines/tungsten-200a/targets.json $(BIN)/report always
	$(RERUN) $(BIN)/report page --study tungsten-200a --out $@ \
	  --arc tungsten=build/tungsten-200a/arc.mcap --targets pipelines/tungsten-200a/targets.json

VALIDATED += tungsten-200a
.PHONY: validate-tungsten-200a
validate-tungsten-200a: build/tungsten-200a/report.html ## the tungsten arc against published bands
	$(BIN)/report validate --arc tungsten=build/tungsten-200a/arc.mcap --targets pipelines/tungsten-200a/targets.json

.PRECIOUS: build/tungsten-200a/arc.mcap build/tungsten-200a/report.html
