# gmaw-300a: gas metal arc welding of mild steel, 300 A in argon, a 10 s weld of 52,000 particles.

.PHONY: gmaw-300a
gmaw-300a: build/gmaw-300a/report.html ## the full weld: arc, pool, averages, report (three quarters of an hour)

build/gmaw-300a/arc.mcap: pipelines/gmaw-300a/arc.json build/gases/argon.mcap $(BIN)/arcfvm always
	$(RERUN) $(BIN)/arcfvm run pipelines/gmaw-300a/arc.json \
	  --input gas=build/gases/argon.mcap --out $@ $(MACHINE)

build/gmaw-300a/pool.mcap: pipelines/gmaw-300a/pool.json build/gmaw-300a/arc.mcap $(BIN)/poolsph always
	$(RERUN) $(BIN)/poolsph run pipelines/gmaw-300a/pool.json \
	  --input arc=build/gmaw-300a/arc.mcap --out $@ $(MACHINE)

build/gmaw-300a/mean.mcap: pipelines/gmaw-300a/avg.json build/gmaw-300a/pool.mcap $(BIN)/avg always
	$(RERUN) $(BIN)/avg run pipelines/gmaw-300a/avg.json \
	  --input frames=build/gmaw-300a/pool.mcap --out $@ $(MACHINE)

build/gmaw-300a/report.html: build/gmaw-300a/arc.mcap build/gmaw-300a/pool.mcap build/gmaw-300a/mean.mcap \
  pipelines/gmaw-300a/targets.json $(call certificate,gmaw-300a) $(BIN)/report always
	$(RERUN) $(BIN)/report page --study gmaw-300a --out $@ \
	  --arc build/gmaw-300a/arc.mcap --pool build/gmaw-300a/pool.mcap --mean build/gmaw-300a/mean.mcap \
	  --targets pipelines/gmaw-300a/targets.json $(call certified,gmaw-300a)

VALIDATED += gmaw-300a
.PHONY: validate-gmaw-300a
validate-gmaw-300a: build/gmaw-300a/report.html ## the weld against published beads (three quarters of an hour)
	$(BIN)/report validate --pool build/gmaw-300a/pool.mcap --targets pipelines/gmaw-300a/targets.json $(call certified,gmaw-300a)

.PRECIOUS: build/gmaw-300a/arc.mcap build/gmaw-300a/pool.mcap build/gmaw-300a/mean.mcap build/gmaw-300a/report.html
