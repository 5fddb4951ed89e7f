# first-weld: a weld that is small enough to be changed and made again while one waits: an arc, and 0.3 s of its pool.

.PHONY: first-weld
first-weld: build/first-weld/report.html ## a small weld with its own arc, to start a study of your own from (minutes)

build/first-weld/arc.mcap: pipelines/gmaw-300a/arc.json pipelines/first-weld/arc.patch.json build/gases/argon.mcap $(BIN)/arcfvm always
	$(RERUN) $(BIN)/arcfvm run pipelines/gmaw-300a/arc.json --patch pipelines/first-weld/arc.patch.json \
	  --input gas=build/gases/argon.mcap --out $@ $(MACHINE)

build/first-weld/pool.mcap: pipelines/gmaw-300a/pool.json pipelines/first-weld/pool.patch.json \
  build/first-weld/arc.mcap $(BIN)/poolsph always
	$(RERUN) $(BIN)/poolsph run pipelines/gmaw-300a/pool.json --patch pipelines/first-weld/pool.patch.json \
	  --input arc=build/first-weld/arc.mcap --out $@ $(MACHINE)

build/first-weld/report.html: build/first-weld/arc.mcap build/first-weld/pool.mcap $(BIN)/report always
	$(RERUN) $(BIN)/report page --study first-weld --out $@ --arc build/first-weld/arc.mcap --pool build/first-weld/pool.mcap

.PRECIOUS: build/first-weld/arc.mcap build/first-weld/pool.mcap build/first-weld/report.html
