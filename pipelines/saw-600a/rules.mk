# saw-600a: submerged arc welding at 600 A and 5 mm/s: a bed of flux at rest, then powder, slag and metal in one run.

.PHONY: saw-600a
saw-600a: build/saw-600a/report.html ## powder, slag and metal of a submerged arc weld of 5 s (long)

build/saw-600a/bed.mcap: pipelines/saw-600a/bed.json $(BIN)/poolsph always
	$(RERUN) $(BIN)/poolsph run pipelines/saw-600a/bed.json --out $@ $(MACHINE)

build/saw-600a/weld.mcap: pipelines/saw-600a/weld.json build/saw-600a/bed.mcap build/gmaw-600a/arc.mcap $(BIN)/poolsph always
	$(RERUN) $(BIN)/poolsph run pipelines/saw-600a/weld.json \
	  --input arc=build/gmaw-600a/arc.mcap --input bed=build/saw-600a/bed.mcap --out $@ $(MACHINE)

# Half of it beside its mirror plane.
.PHONY: saw-600a-half
saw-600a-half: build/saw-600a/half-report.html ## half of saw-600a beside its mirror plane (long)

build/saw-600a/half-bed.mcap: pipelines/saw-600a/bed.json pipelines/saw-600a/half-bed.patch.json $(BIN)/poolsph always
	$(RERUN) $(BIN)/poolsph run pipelines/saw-600a/bed.json --patch pipelines/saw-600a/half-bed.patch.json --out $@ $(MACHINE)

build/saw-600a/half.mcap: pipelines/saw-600a/weld.json pipelines/saw-600a/half.patch.json \
  build/saw-600a/half-bed.mcap build/gmaw-600a/arc.mcap $(BIN)/poolsph always
	$(RERUN) $(BIN)/poolsph run pipelines/saw-600a/weld.json --patch pipelines/saw-600a/half.patch.json \
	  --input arc=build/gmaw-600a/arc.mcap --input bed=build/saw-600a/half-bed.mcap --out $@ $(MACHINE)

# Flux and slag around the cavity, averaged on a grid that moves with it; the heat that they bring to the metal, on one that rests.
SAW_600A := weld half

$(SAW_600A:%=build/saw-600a/%-flux.mcap): build/saw-600a/%-flux.mcap: pipelines/saw-600a/flux.json \
  build/saw-600a/%.mcap $(BIN)/avg always
	$(RERUN) $(BIN)/avg run pipelines/saw-600a/flux.json --input frames=build/saw-600a/$*.mcap --out $@ $(MACHINE)

$(SAW_600A:%=build/saw-600a/%-slag.mcap): build/saw-600a/%-slag.mcap: pipelines/saw-600a/flux.json \
  pipelines/saw-600a/slag.patch.json build/saw-600a/%.mcap $(BIN)/avg always
	$(RERUN) $(BIN)/avg run pipelines/saw-600a/flux.json --patch pipelines/saw-600a/slag.patch.json \
	  --input frames=build/saw-600a/$*.mcap --out $@ $(MACHINE)

$(SAW_600A:%=build/saw-600a/%-heat.mcap): build/saw-600a/%-heat.mcap: pipelines/saw-600a/heat.json \
  build/saw-600a/%.mcap $(BIN)/avg always
	$(RERUN) $(BIN)/avg run pipelines/saw-600a/heat.json --input frames=build/saw-600a/$*.mcap --out $@ $(MACHINE)

build/saw-600a/report.html: SAW_RUN := weld
build/saw-600a/half-report.html: SAW_RUN := half
build/saw-600a/report.html: $(foreach what,.mcap -flux.mcap -slag.mcap -heat.mcap,build/saw-600a/weld$(what))
build/saw-600a/half-report.html: $(foreach what,.mcap -flux.mcap -slag.mcap -heat.mcap,build/saw-600a/half$(what))
build/saw-600a/report.html build/saw-600a/half-report.html: build/gmaw-600a/arc.mcap pipelines/saw-600a/targets.json $(BIN)/report always
	$(RERUN) $(BIN)/report page --study saw-600a --out $@ \
	  --arc build/gmaw-600a/arc.mcap --pool build/saw-600a/$(SAW_RUN).mcap --mean flux=build/saw-600a/$(SAW_RUN)-flux.mcap \
	  --mean slag=build/saw-600a/$(SAW_RUN)-slag.mcap --mean heat=build/saw-600a/$(SAW_RUN)-heat.mcap \
	  --targets pipelines/saw-600a/targets.json

.PRECIOUS: $(SAW_600A:%=build/saw-600a/%.mcap) $(SAW_600A:%=build/saw-600a/%-flux.mcap) $(SAW_600A:%=build/saw-600a/%-slag.mcap) \
  $(SAW_600A:%=build/saw-600a/%-heat.mcap) build/saw-600a/bed.mcap build/saw-600a/half-bed.mcap build/saw-600a/weld.mcap \
  build/saw-600a/half.mcap build/saw-600a/report.html build/saw-600a/half-report.html
