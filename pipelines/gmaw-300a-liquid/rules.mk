# gmaw-300a-liquid: the weld of gmaw-300a on a plate as thick as the measured one, with metal that flows as a liquid and sticks to
# cold metal. Arc and pool come in turns: three young pools of a second, each but the first under the arc over the mean surface of
# the one before, and then the weld under the arc over that of the third.

LIQUID := build/gmaw-300a-liquid
LIQUID_YOUNG := $(LIQUID)/pool-1.mcap $(LIQUID)/pool-2.mcap $(LIQUID)/pool-3.mcap
LIQUID_MEANS := $(LIQUID)/mean-1.mcap $(LIQUID)/mean-2.mcap $(LIQUID)/mean-3.mcap
LIQUID_ARCS := $(LIQUID)/arc-2.mcap $(LIQUID)/arc-3.mcap $(LIQUID)/arc-4.mcap

.PHONY: gmaw-300a-liquid
gmaw-300a-liquid: $(LIQUID)/report.html ## gmaw-300a with metal that flows as a liquid, arc and pool in turns (half an hour and more)

$(LIQUID)/pool-1.mcap: build/gmaw-300a/arc.mcap
$(LIQUID)/pool-2.mcap: $(LIQUID)/arc-2.mcap
$(LIQUID)/pool-3.mcap: $(LIQUID)/arc-3.mcap
$(LIQUID)/arc-2.mcap: $(LIQUID)/mean-1.mcap
$(LIQUID)/arc-3.mcap: $(LIQUID)/mean-2.mcap
$(LIQUID)/arc-4.mcap: $(LIQUID)/mean-3.mcap

$(LIQUID_YOUNG): pipelines/gmaw-300a/pool.json pipelines/gmaw-300a-liquid/pool.patch.json pipelines/gmaw-quick/pool.patch.json \
  $(BIN)/poolsph always
	$(RERUN) $(BIN)/poolsph run pipelines/gmaw-300a/pool.json \
	  --patch pipelines/gmaw-300a-liquid/pool.patch.json --patch pipelines/gmaw-quick/pool.patch.json \
	  --input arc=$(filter %/arc.mcap $(LIQUID)/arc-%,$^) --out $@ $(MACHINE)

$(LIQUID_MEANS): $(LIQUID)/mean-%.mcap: pipelines/gmaw-300a/avg.json pipelines/gmaw-quick/avg.patch.json \
  pipelines/gmaw-two-pass/avg.patch.json $(LIQUID)/pool-%.mcap $(BIN)/avg always
	$(RERUN) $(BIN)/avg run pipelines/gmaw-300a/avg.json \
	  --patch pipelines/gmaw-quick/avg.patch.json --patch pipelines/gmaw-two-pass/avg.patch.json \
	  --input frames=$(LIQUID)/pool-$*.mcap --out $@ $(MACHINE)

$(LIQUID_ARCS): pipelines/gmaw-300a/arc.json pipelines/gmaw-two-pass/arc.patch.json build/gases/argon.mcap $(BIN)/arcfvm always
	$(RERUN) $(BIN)/arcfvm run pipelines/gmaw-300a/arc.json \
	  --patch pipelines/gmaw-two-pass/arc.patch.json --input gas=build/gases/argon.mcap \
	  --input surface=$(filter $(LIQUID)/mean-%,$^) --out $@ $(MACHINE)

$(LIQUID)/pool.mcap: pipelines/gmaw-300a/pool.json pipelines/gmaw-300a-liquid/pool.patch.json \
  $(LIQUID)/arc-4.mcap $(BIN)/poolsph always
	$(RERUN) $(BIN)/poolsph run pipelines/gmaw-300a/pool.json \
	  --patch pipelines/gmaw-300a-liquid/pool.patch.json \
	  --input arc=$(LIQUID)/arc-4.mcap --out $@ $(MACHINE)

$(LIQUID)/mean.mcap: pipelines/gmaw-300a/avg.json $(LIQUID)/pool.mcap $(BIN)/avg always
	$(RERUN) $(BIN)/avg run pipelines/gmaw-300a/avg.json \
	  --input frames=$(LIQUID)/pool.mcap --out $@ $(MACHINE)

$(LIQUID)/report.html: $(LIQUID)/arc-4.mcap $(LIQUID)/pool.mcap $(LIQUID)/mean.mcap pipelines/gmaw-300a/targets.json \
  $(BIN)/report always
	$(RERUN) $(BIN)/report page --study gmaw-300a-liquid --out $@ \
	  --arc $(LIQUID)/arc-4.mcap --pool $(LIQUID)/pool.mcap --mean $(LIQUID)/mean.mcap --targets pipelines/gmaw-300a/targets.json

.PHONY: validate-gmaw-300a-liquid
validate-gmaw-300a-liquid: $(LIQUID)/report.html ## the liquid weld against published beads (as long; not part of validate)
	$(BIN)/report validate --pool $(LIQUID)/pool.mcap --targets pipelines/gmaw-300a/targets.json

.PRECIOUS: $(LIQUID_YOUNG) $(LIQUID_MEANS) $(LIQUID_ARCS) $(LIQUID)/pool.mcap $(LIQUID)/mean.mcap $(LIQUID)/report.html
