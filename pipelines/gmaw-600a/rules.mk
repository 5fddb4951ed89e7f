# gmaw-600a: the heat source of gas metal arc welding with the wire and current of the submerged arc.

.PHONY: gmaw-600a
gmaw-600a: build/gmaw-600a/report.html ## gas metal arc of 600 A in carbon monoxide, with its report

build/gmaw-600a/arc.mcap: pipelines/gmaw-600a/arc.json build/gases/co-iron-ten-micrometres.mcap $(BIN)/arcfvm always
	$(RERUN) $(BIN)/arcfvm run pipelines/gmaw-600a/arc.json \
	  --input gas=build/gases/co-iron-ten-micrometres.mcap --out $@ $(MACHINE)

build/gmaw-600a/report.html: build/gmaw-600a/arc.mcap pipelines/gmaw-600a/targets.json $(call certificate,gmaw-600a) $(BIN)/report always
	$(RERUN) $(BIN)/report page --study gmaw-600a --out $@ \
	  --arc gmaw=build/gmaw-600a/arc.mcap --targets pipelines/gmaw-600a/targets.json $(call certified,gmaw-600a)

VALIDATED += gmaw-600a
.PHONY: validate-gmaw-600a
validate-gmaw-600a: build/gmaw-600a/report.html ## the gas metal arc of 600 A against published values
	$(BIN)/report validate --arc gmaw=build/gmaw-600a/arc.mcap --targets pipelines/gmaw-600a/targets.json $(call certified,gmaw-600a)

.PRECIOUS: build/gmaw-600a/arc.mcap build/gmaw-600a/report.html
