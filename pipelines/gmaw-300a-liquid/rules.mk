# gmaw-300a-liquid: the weld of gmaw-300a with metal that flows as a liquid and sticks to cold metal.

.PHONY: gmaw-300a-liquid
gmaw-300a-liquid: build/gmaw-300a-liquid/report.html ## gmaw-300a with metal that flows as a liquid (an hour and more)

build/gmaw-300a-liquid/pool.mcap: pipelines/gmaw-300a/pool.json pipelines/gmaw-300a-liquid/pool.patch.json \
  build/gmaw-300a/arc.mcap $(BIN)/poolsph always
	$(RERUN) $(BIN)/poolsph run pipelines/gmaw-300a/pool.json \
	  --patch pipelines/gmaw-300a-liquid/pool.patch.json \
	  --input arc=build/gmaw-300a/arc.mcap --out $@ $(MACHINE)

build/gmaw-300a-liquid/mean.mcap: pipelines/gmaw-300a/avg.json build/gmaw-300a-liquid/pool.mcap $(BIN)/avg always
	$(RERUN) $(BIN)/avg run pipelines/gmaw-300a/avg.json \
	  --input frames=build/gmaw-300a-liquid/pool.mcap --out $@ $(MACHINE)

build/gmaw-300a-liquid/report.html: build/gmaw-300a/arc.mcap build/gmaw-300a-liquid/pool.mcap \
  build/gmaw-300a-liquid/mean.mcap pipelines/gmaw-300a/targets.json $(BIN)/report always
	$(RERUN) $(BIN)/report page --study gmaw-300a-liquid --out $@ \
	  --arc build/gmaw-300a/arc.mcap --pool build/gmaw-300a-liquid/pool.mcap \
	  --mean build/gmaw-300a-liquid/mean.mcap --targets pipelines/gmaw-300a/targets.json

.PHONY: validate-gmaw-300a-liquid
validate-gmaw-300a-liquid: build/gmaw-300a-liquid/report.html ## the liquid weld against published beads (as long; not part of validate)
	$(BIN)/report validate --pool build/gmaw-300a-liquid/pool.mcap --targets pipelines/gmaw-300a/targets.json

.PRECIOUS: build/gmaw-300a-liquid/pool.mcap build/gmaw-300a-liquid/mean.mcap build/gmaw-300a-liquid/report.html
