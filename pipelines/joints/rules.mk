# joints: a groove, a T-joint, a lap joint and an angle turned up, each welded for a second on coarse particles.

JOINTS := groove tee lap trough
.PHONY: joints
joints: $(JOINTS:%=build/joints/%.html) ## a groove and three fillets under a torch with drops (minutes)

build/joints/groove.mcap: pipelines/joints/groove.json $(BIN)/poolsph always
	$(RERUN) $(BIN)/poolsph run pipelines/joints/groove.json --out $@ $(MACHINE)

build/joints/tee.mcap build/joints/lap.mcap build/joints/trough.mcap: build/joints/%.mcap: pipelines/joints/groove.json \
  pipelines/joints/%.patch.json $(BIN)/poolsph always
	$(RERUN) $(BIN)/poolsph run pipelines/joints/groove.json --patch pipelines/joints/$*.patch.json --out $@ $(MACHINE)

$(JOINTS:%=build/joints/%.html): build/joints/%.html: build/joints/%.mcap $(BIN)/report always
	$(RERUN) $(BIN)/report page --study joints --pool $< --out $@

.PRECIOUS: build/joints/groove.mcap
.PRECIOUS: build/joints/tee.mcap build/joints/lap.mcap build/joints/trough.mcap
.PRECIOUS: $(JOINTS:%=build/joints/%.html)
