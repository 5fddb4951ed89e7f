# saw-600a-arc: the heat source of submerged arc welding, 600 A, and what polarity, current and cathode change.

.PHONY: saw-600a-arc
saw-600a-arc: build/saw-600a-arc/report.html ## submerged arc in flux: both polarities, 400 and 600 A, two cathodes, with their report

SAW := pipelines/saw-600a-arc
SAW_VARIANTS := dcep-400 dcen-600 dcen-600-fall fall melting even cells-0.4 cells-0.2

build/saw-600a-arc/dcep.mcap: $(SAW)/arc.json build/gases/co-iron.mcap $(BIN)/arcfvm always
	$(RERUN) $(BIN)/arcfvm run $(SAW)/arc.json --input gas=build/gases/co-iron.mcap --out $@ $(MACHINE)

$(SAW_VARIANTS:%=build/saw-600a-arc/%.mcap): build/saw-600a-arc/%.mcap: $(SAW)/arc.json $(SAW)/%.patch.json \
  build/gases/co-iron.mcap $(BIN)/arcfvm always
	$(RERUN) $(BIN)/arcfvm run $(SAW)/arc.json --patch $(SAW)/$*.patch.json \
	  --input gas=build/gases/co-iron.mcap --out $@ $(MACHINE)

SAW_ARCS := dcep=build/saw-600a-arc/dcep.mcap dcep-400=build/saw-600a-arc/dcep-400.mcap \
  dcen=build/saw-600a-arc/dcen-600.mcap dcen-fall=build/saw-600a-arc/dcen-600-fall.mcap \
  fall=build/saw-600a-arc/fall.mcap melting=build/saw-600a-arc/melting.mcap \
  even=build/saw-600a-arc/even.mcap cells-0.4=build/saw-600a-arc/cells-0.4.mcap cells-0.2=build/saw-600a-arc/cells-0.2.mcap

build/saw-600a-arc/report.html: build/saw-600a-arc/dcep.mcap $(SAW_VARIANTS:%=build/saw-600a-arc/%.mcap) \
  $(SAW)/targets.json $(call certificate,saw-600a-arc) $(BIN)/report always
	$(RERUN) $(BIN)/report page --study saw-600a-arc --out $@ \
	  $(SAW_ARCS:%=--arc %) --targets $(SAW)/targets.json $(call certified,saw-600a-arc)

VALIDATED += saw-600a-arc
.PHONY: validate-saw-600a-arc
validate-saw-600a-arc: build/saw-600a-arc/report.html ## the submerged arc against published values, row by row
	$(BIN)/report validate $(SAW_ARCS:%=--arc %) --targets $(SAW)/targets.json $(call certified,saw-600a-arc)

.PRECIOUS: build/saw-600a-arc/dcep.mcap $(SAW_VARIANTS:%=build/saw-600a-arc/%.mcap) build/saw-600a-arc/report.html
