# saw-quick: the first 0.6 s of saw-600a on particles of 1 mm, in a smaller box. The arc is that of gmaw-600a.

.PHONY: saw-quick
saw-quick: build/saw-quick/report.html ## the first 0.6 s of a submerged arc weld on coarse particles (minutes)

build/saw-quick/bed.mcap: pipelines/saw-600a/bed.json pipelines/saw-quick/bed.patch.json $(BIN)/poolsph always
	$(RERUN) $(BIN)/poolsph run pipelines/saw-600a/bed.json \
	  --patch pipelines/saw-quick/bed.patch.json --out $@ $(MACHINE)

build/saw-quick/weld.mcap: pipelines/saw-600a/weld.json pipelines/saw-quick/weld.patch.json \
  build/saw-quick/bed.mcap build/gmaw-600a/arc.mcap $(BIN)/poolsph always
	$(RERUN) $(BIN)/poolsph run pipelines/saw-600a/weld.json \
	  --patch pipelines/saw-quick/weld.patch.json \
	  --input arc=build/gmaw-600a/arc.mcap --input bed=build/saw-quick/bed.mcap --out $@ $(MACHINE)

SAW_QUICK_VARIANTS := wire overlap
.PHONY: saw-quick-variants
saw-quick-variants: $(SAW_QUICK_VARIANTS:%=build/saw-quick/%.mcap) ## saw-quick with other drops, and with wider contacts (minutes)

$(SAW_QUICK_VARIANTS:%=build/saw-quick/%.mcap): build/saw-quick/%.mcap: pipelines/saw-600a/weld.json \
  pipelines/saw-quick/weld.patch.json pipelines/saw-quick/%.patch.json \
  build/saw-quick/bed.mcap build/gmaw-600a/arc.mcap $(BIN)/poolsph always
	$(RERUN) $(BIN)/poolsph run pipelines/saw-600a/weld.json \
	  --patch pipelines/saw-quick/weld.patch.json --patch pipelines/saw-quick/$*.patch.json \
	  --input arc=build/gmaw-600a/arc.mcap --input bed=build/saw-quick/bed.mcap --out $@ $(MACHINE)

# Half of it beside its mirror plane.
.PHONY: saw-quick-half
saw-quick-half: build/saw-quick/half.mcap ## half of saw-quick beside its mirror plane (minutes)

build/saw-quick/half-bed.mcap: pipelines/saw-600a/bed.json pipelines/saw-quick/bed.patch.json \
  pipelines/saw-quick/half-bed.patch.json $(BIN)/poolsph always
	$(RERUN) $(BIN)/poolsph run pipelines/saw-600a/bed.json --patch pipelines/saw-quick/bed.patch.json \
	  --patch pipelines/saw-quick/half-bed.patch.json --out $@ $(MACHINE)

build/saw-quick/half.mcap: pipelines/saw-600a/weld.json pipelines/saw-quick/weld.patch.json \
  pipelines/saw-quick/half.patch.json build/saw-quick/half-bed.mcap build/gmaw-600a/arc.mcap $(BIN)/poolsph always
	$(RERUN) $(BIN)/poolsph run pipelines/saw-600a/weld.json \
	  --patch pipelines/saw-quick/weld.patch.json --patch pipelines/saw-quick/half.patch.json \
	  --input arc=build/gmaw-600a/arc.mcap --input bed=build/saw-quick/half-bed.mcap --out $@ $(MACHINE)

build/saw-quick/heat.mcap: pipelines/saw-600a/heat.json pipelines/saw-quick/heat.patch.json \
  build/saw-quick/weld.mcap $(BIN)/avg always
	$(RERUN) $(BIN)/avg run pipelines/saw-600a/heat.json --patch pipelines/saw-quick/heat.patch.json \
	  --input frames=build/saw-quick/weld.mcap --out $@ $(MACHINE)

build/saw-quick/report.html: build/gmaw-600a/arc.mcap build/saw-quick/weld.mcap build/saw-quick/heat.mcap $(BIN)/report always
	$(RERUN) $(BIN)/report page --study saw-quick --out $@ \
	  --arc build/gmaw-600a/arc.mcap --pool build/saw-quick/weld.mcap --mean heat=build/saw-quick/heat.mcap

.PRECIOUS: $(SAW_QUICK_VARIANTS:%=build/saw-quick/%.mcap) build/saw-quick/bed.mcap build/saw-quick/weld.mcap build/saw-quick/heat.mcap build/saw-quick/report.html \
  build/saw-quick/half-bed.mcap build/saw-quick/half.mcap
