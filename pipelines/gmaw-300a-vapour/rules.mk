# gmaw-300a-vapour: the weld of gmaw-300a under an arc that holds the iron of its electrodes.

.PHONY: gmaw-300a-vapour
gmaw-300a-vapour: build/gmaw-300a-vapour/report.html ## gmaw-300a with iron vapour in the arc (three quarters of an hour)

build/gmaw-300a-vapour/arc.mcap: pipelines/gmaw-300a/arc.json pipelines/gmaw-300a-vapour/arc.patch.json \
  build/gases/argon-iron.mcap $(BIN)/arcfvm always
	$(RERUN) $(BIN)/arcfvm run pipelines/gmaw-300a/arc.json \
	  --patch pipelines/gmaw-300a-vapour/arc.patch.json \
	  --input gas=build/gases/argon-iron.mcap --out $@ $(MACHINE)

build/gmaw-300a-vapour/pool.mcap: pipelines/gmaw-300a/pool.json build/gmaw-300a-vapour/arc.mcap $(BIN)/poolsph always
	$(RERUN) $(BIN)/poolsph run pipelines/gmaw-300a/pool.json \
	  --input arc=build/gmaw-300a-vapour/arc.mcap --out $@ $(MACHINE)

build/gmaw-300a-vapour/mean.mcap: pipelines/gmaw-300a/avg.json build/gmaw-300a-vapour/pool.mcap $(BIN)/avg always
	$(RERUN) $(BIN)/avg run pipelines/gmaw-300a/avg.json \
	  --input frames=build/gmaw-300a-vapour/pool.mcap --out $@ $(MACHINE)

build/gmaw-300a-vapour/report.html: build/gmaw-300a-vapour/arc.mcap build/gmaw-300a-vapour/pool.mcap \
  build/gmaw-300a-vapour/mean.mcap pipelines/gmaw-300a/targets.json $(BIN)/report always
	$(RERUN) $(BIN)/report page --study gmaw-300a-vapour --out $@ \
	  --arc build/gmaw-300a-vapour/arc.mcap --pool build/gmaw-300a-vapour/pool.mcap \
	  --mean build/gmaw-300a-vapour/mean.mcap --targets pipelines/gmaw-300a/targets.json

.PHONY: validate-gmaw-300a-vapour
validate-gmaw-300a-vapour: build/gmaw-300a-vapour/report.html ## the weld with iron vapour against published beads (as long; not part of validate)
	$(BIN)/report validate --pool build/gmaw-300a-vapour/pool.mcap --targets pipelines/gmaw-300a/targets.json

.PRECIOUS: build/gmaw-300a-vapour/arc.mcap build/gmaw-300a-vapour/pool.mcap \
  build/gmaw-300a-vapour/mean.mcap build/gmaw-300a-vapour/report.html
