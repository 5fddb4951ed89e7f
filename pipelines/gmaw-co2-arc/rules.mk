# gmaw-co2-arc: the gas metal arc of 300 A in argon and in argon with carbon dioxide, each with the iron of its electrodes.

.PHONY: gmaw-co2-arc
gmaw-co2-arc: build/gmaw-co2-arc/report.html ## gas metal arc of 300 A in Ar and in Ar + 20 % CO2, side by side (minutes)

build/gmaw-co2-arc/%.mcap: pipelines/gmaw-300a/arc.json pipelines/gmaw-300a-vapour/arc.patch.json \
  pipelines/gmaw-co2-arc/%.patch.json build/gases/%-iron.mcap $(BIN)/arcfvm always
	$(RERUN) $(BIN)/arcfvm run pipelines/gmaw-300a/arc.json \
	  --patch pipelines/gmaw-300a-vapour/arc.patch.json --patch pipelines/gmaw-co2-arc/$*.patch.json \
	  --input gas=build/gases/$*-iron.mcap --out $@ $(MACHINE)

build/gmaw-co2-arc/report.html: build/gmaw-co2-arc/argon.mcap build/gmaw-co2-arc/argon-co2.mcap $(BIN)/report always
	$(RERUN) $(BIN)/report page --study gmaw-co2-arc --out $@ \
	  --arc argon=build/gmaw-co2-arc/argon.mcap --arc argon-co2=build/gmaw-co2-arc/argon-co2.mcap

.PRECIOUS: build/gmaw-co2-arc/%.mcap build/gmaw-co2-arc/report.html
