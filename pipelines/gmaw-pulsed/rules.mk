# gmaw-pulsed: an arc that pulses between 400 and 100 A, a drop with each pulse, over the plate of gmaw-300a.

PULSED := build/gmaw-pulsed

.PHONY: gmaw-pulsed
gmaw-pulsed: $(PULSED)/report.html ## a pulsed arc: two arcs in turn over one pool, its first second (minutes)

$(PULSED)/%.mcap: pipelines/gmaw-300a/arc.json pipelines/gmaw-pulsed/%.patch.json build/gases/argon.mcap \
  $(BIN)/arcfvm always
	$(RERUN) $(BIN)/arcfvm run pipelines/gmaw-300a/arc.json --patch pipelines/gmaw-pulsed/$*.patch.json \
	  --input gas=build/gases/argon.mcap --out $@ $(MACHINE)

$(PULSED)/pool.mcap: pipelines/gmaw-300a/pool.json pipelines/gmaw-pulsed/pool.patch.json $(PULSED)/peak.mcap \
  $(PULSED)/base.mcap $(BIN)/poolsph always
	$(RERUN) $(BIN)/poolsph run pipelines/gmaw-300a/pool.json --patch pipelines/gmaw-pulsed/pool.patch.json \
	  --input arc=$(PULSED)/peak.mcap --input arc2=$(PULSED)/base.mcap --out $@ $(MACHINE)

$(PULSED)/mean.mcap: pipelines/gmaw-300a/avg.json pipelines/gmaw-quick/avg.patch.json $(PULSED)/pool.mcap \
  $(BIN)/avg always
	$(RERUN) $(BIN)/avg run pipelines/gmaw-300a/avg.json --patch pipelines/gmaw-quick/avg.patch.json \
	  --input frames=$(PULSED)/pool.mcap --out $@ $(MACHINE)

$(PULSED)/report.html: $(PULSED)/peak.mcap $(PULSED)/base.mcap $(PULSED)/pool.mcap $(PULSED)/mean.mcap \
  $(BIN)/report always
	$(RERUN) $(BIN)/report page --study gmaw-pulsed --out $@ \
	  --arc peak=$(PULSED)/peak.mcap --arc base=$(PULSED)/base.mcap \
	  --pool $(PULSED)/pool.mcap --mean $(PULSED)/mean.mcap

.PRECIOUS: $(PULSED)/%.mcap $(PULSED)/peak.mcap $(PULSED)/base.mcap $(PULSED)/pool.mcap $(PULSED)/mean.mcap $(PULSED)/report.html
