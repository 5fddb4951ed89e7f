# gmaw-quick: the first second of gmaw-300a at full resolution. The arc is the same, and made once.

.PHONY: gmaw-quick
gmaw-quick: build/gmaw-quick/report.html ## the default study: the first second of gmaw-300a (minutes)

build/gmaw-quick/pool.mcap: pipelines/gmaw-300a/pool.json pipelines/gmaw-quick/pool.patch.json \
  build/gmaw-300a/arc.mcap $(BIN)/poolsph always
	$(RERUN) $(BIN)/poolsph run pipelines/gmaw-300a/pool.json \
	  --patch pipelines/gmaw-quick/pool.patch.json \
	  --input arc=build/gmaw-300a/arc.mcap --out $@ $(MACHINE)

build/gmaw-quick/mean.mcap: pipelines/gmaw-300a/avg.json pipelines/gmaw-quick/avg.patch.json \
  build/gmaw-quick/pool.mcap $(BIN)/avg always
	$(RERUN) $(BIN)/avg run pipelines/gmaw-300a/avg.json \
	  --patch pipelines/gmaw-quick/avg.patch.json \
	  --input frames=build/gmaw-quick/pool.mcap --out $@ $(MACHINE)

build/gmaw-quick/report.html: build/gmaw-300a/arc.mcap build/gmaw-quick/pool.mcap build/gmaw-quick/mean.mcap \
  pipelines/gmaw-300a/targets.json $(call certificate,gmaw-quick) $(BIN)/report always
	$(RERUN) $(BIN)/report page --study gmaw-quick --out $@ \
	  --arc build/gmaw-300a/arc.mcap --pool build/gmaw-quick/pool.mcap --mean build/gmaw-quick/mean.mcap \
	  --targets pipelines/gmaw-300a/targets.json $(call certified,gmaw-quick)

.PRECIOUS: build/gmaw-quick/pool.mcap build/gmaw-quick/mean.mcap build/gmaw-quick/report.html
