# gases: tables of plasma properties, and what is uncertain of them.

.PHONY: gases
gases: build/gases/report.html ## tables of argon, CO and Ar + 20 % CO2 with iron vapour, with their report

build/gases/%.mcap: pipelines/gases/%.json $(BIN)/gasprop always
	$(RERUN) $(BIN)/gasprop run $< --out $@ $(MACHINE)

# Argon with iron once more, with other values of what no measurement settles.
build/gases/argon-iron-%.mcap: pipelines/gases/argon-iron.json pipelines/gases/%.patch.json $(BIN)/gasprop always
	$(RERUN) $(BIN)/gasprop run $< --patch pipelines/gases/$*.patch.json --out $@ $(MACHINE)

# The gas of section 5.2.5 of Komen (2019), which lets nearly all light out.
build/gases/co-iron-ten-micrometres.mcap: pipelines/gases/co-iron.json \
  pipelines/gases/ten-micrometres.patch.json $(BIN)/gasprop always
	$(RERUN) $(BIN)/gasprop run $< --patch pipelines/gases/ten-micrometres.patch.json --out $@ $(MACHINE)

# Argon at the pressure at which the published table stands.
build/gases/argon-reference-pressure.mcap: pipelines/gases/argon.json \
  pipelines/gases/reference-pressure.patch.json $(BIN)/gasprop always
	$(RERUN) $(BIN)/gasprop run $< --patch pipelines/gases/reference-pressure.patch.json --out $@ $(MACHINE)

GASES := argon argon-iron co-iron argon-co2-iron
GAS_VARIANTS := electron-iron-20 electron-iron-80 iron-exchange-2 thin five-millimetres

build/gases/report.html: $(GASES:%=build/gases/%.mcap) $(GAS_VARIANTS:%=build/gases/argon-iron-%.mcap) \
  build/gases/argon-reference-pressure.mcap pipelines/gases/reference-argon.json $(BIN)/report always
	$(RERUN) $(BIN)/report gas --study gases --out $@ \
	  $(foreach gas,$(GASES),--table $(gas)=build/gases/$(gas).mcap) \
	  --variant argon/reference-pressure=build/gases/argon-reference-pressure.mcap \
	  --reference argon/reference-pressure=pipelines/gases/reference-argon.json \
	  $(foreach variant,$(GAS_VARIANTS),--variant argon-iron/$(variant)=build/gases/argon-iron-$(variant).mcap)

.PRECIOUS: build/gases/%.mcap build/gases/argon-iron-%.mcap build/gases/co-iron-ten-micrometres.mcap \
  build/gases/argon-reference-pressure.mcap build/gases/report.html
