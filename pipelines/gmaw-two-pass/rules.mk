# gmaw-two-pass: the arc of gmaw-300a once more, over the pool that it has made, and the pool under that arc.
# The first pass is gmaw-quick.

TWO := build/gmaw-two-pass

.PHONY: gmaw-two-pass
gmaw-two-pass: $(TWO)/report.html ## arc and pool in turns through files: what the second pass changes (minutes)

$(TWO)/mean-first.mcap: pipelines/gmaw-300a/avg.json pipelines/gmaw-quick/avg.patch.json \
  pipelines/gmaw-two-pass/avg.patch.json build/gmaw-quick/pool.mcap $(BIN)/avg always
	$(RERUN) $(BIN)/avg run pipelines/gmaw-300a/avg.json \
	  --patch pipelines/gmaw-quick/avg.patch.json --patch pipelines/gmaw-two-pass/avg.patch.json \
	  --input frames=build/gmaw-quick/pool.mcap --out $@ $(MACHINE)

$(TWO)/arc.mcap: pipelines/gmaw-300a/arc.json pipelines/gmaw-two-pass/arc.patch.json build/gases/argon.mcap \
  $(TWO)/mean-first.mcap $(BIN)/arcfvm always
	$(RERUN) $(BIN)/arcfvm run pipelines/gmaw-300a/arc.json \
	  --patch pipelines/gmaw-two-pass/arc.patch.json --input gas=build/gases/argon.mcap \
	  --input surface=$(TWO)/mean-first.mcap --out $@ $(MACHINE)

$(TWO)/pool.mcap: pipelines/gmaw-300a/pool.json pipelines/gmaw-quick/pool.patch.json $(TWO)/arc.mcap $(BIN)/poolsph always
	$(RERUN) $(BIN)/poolsph run pipelines/gmaw-300a/pool.json \
	  --patch pipelines/gmaw-quick/pool.patch.json --input arc=$(TWO)/arc.mcap --out $@ $(MACHINE)

$(TWO)/mean.mcap: pipelines/gmaw-300a/avg.json pipelines/gmaw-quick/avg.patch.json \
  pipelines/gmaw-two-pass/avg.patch.json $(TWO)/pool.mcap $(BIN)/avg always
	$(RERUN) $(BIN)/avg run pipelines/gmaw-300a/avg.json \
	  --patch pipelines/gmaw-quick/avg.patch.json --patch pipelines/gmaw-two-pass/avg.patch.json \
	  --input frames=$(TWO)/pool.mcap --out $@ $(MACHINE)

$(TWO)/report.html: build/gmaw-300a/arc.mcap $(TWO)/arc.mcap build/gmaw-quick/pool.mcap $(TWO)/pool.mcap \
  $(TWO)/mean-first.mcap $(TWO)/mean.mcap $(BIN)/report always
	$(RERUN) $(BIN)/report passes --study gmaw-two-pass --out $@ \
	  --arc first=build/gmaw-300a/arc.mcap --arc second=$(TWO)/arc.mcap \
	  --pool first=build/gmaw-quick/pool.mcap --pool second=$(TWO)/pool.mcap \
	  --mean first=$(TWO)/mean-first.mcap --mean second=$(TWO)/mean.mcap

.PRECIOUS: $(TWO)/mean-first.mcap $(TWO)/arc.mcap $(TWO)/pool.mcap $(TWO)/mean.mcap $(TWO)/report.html
