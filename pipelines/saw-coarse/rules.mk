# saw-coarse: the 5 s of saw-600a on particles of 1 mm, half beside its mirror plane. The arc is that of gmaw-600a.

.PHONY: saw-coarse
saw-coarse: build/saw-coarse/report.html ## a submerged arc weld of 5 s on coarse particles (half an hour)

build/saw-coarse/bed.mcap: pipelines/saw-600a/bed.json pipelines/saw-coarse/bed.patch.json $(BIN)/poolsph always
	$(RERUN) $(BIN)/poolsph run pipelines/saw-600a/bed.json --patch pipelines/saw-coarse/bed.patch.json --out $@ $(MACHINE)

build/saw-coarse/weld.mcap: pipelines/saw-600a/weld.json pipelines/saw-coarse/weld.patch.json \
  build/saw-coarse/bed.mcap build/gmaw-600a/arc.mcap $(BIN)/poolsph always
	$(RERUN) $(BIN)/poolsph run pipelines/saw-600a/weld.json --patch pipelines/saw-coarse/weld.patch.json \
	  --input arc=build/gmaw-600a/arc.mcap --input bed=build/saw-coarse/bed.mcap --out $@ $(MACHINE)

build/saw-coarse/flux.mcap: pipelines/saw-600a/flux.json pipelines/saw-coarse/flux.patch.json \
  build/saw-coarse/weld.mcap $(BIN)/avg always
	$(RERUN) $(BIN)/avg run pipelines/saw-600a/flux.json --patch pipelines/saw-coarse/flux.patch.json \
	  --input frames=build/saw-coarse/weld.mcap --out $@ $(MACHINE)

build/saw-coarse/slag.mcap: pipelines/saw-600a/flux.json pipelines/saw-coarse/flux.patch.json pipelines/saw-600a/slag.patch.json \
  build/saw-coarse/weld.mcap $(BIN)/avg always
	$(RERUN) $(BIN)/avg run pipelines/saw-600a/flux.json --patch pipelines/saw-coarse/flux.patch.json \
	  --patch pipelines/saw-600a/slag.patch.json \
	  --input frames=build/saw-coarse/weld.mcap --out $@ $(MACHINE)

build/saw-coarse/heat.mcap: pipelines/saw-600a/heat.json pipelines/saw-coarse/heat.patch.json \
  build/saw-coarse/weld.mcap $(BIN)/avg always
	$(RERUN) $(BIN)/avg run pipelines/saw-600a/heat.json --patch pipelines/saw-coarse/heat.patch.json \
	  --input frames=build/saw-coarse/weld.mcap --out $@ $(MACHINE)

build/saw-coarse/report.html: build/gmaw-600a/arc.mcap build/saw-coarse/weld.mcap build/saw-coarse/flux.mcap \
  build/saw-coarse/slag.mcap build/saw-coarse/heat.mcap pipelines/saw-600a/targets.json $(BIN)/report always
	$(RERUN) $(BIN)/report page --study saw-coarse --out $@ \
	  --arc build/gmaw-600a/arc.mcap --pool build/saw-coarse/weld.mcap --mean flux=build/saw-coarse/flux.mcap \
	  --mean slag=build/saw-coarse/slag.mcap --mean heat=build/saw-coarse/heat.mcap --targets pipelines/saw-600a/targets.json

.PRECIOUS: build/saw-coarse/bed.mcap build/saw-coarse/weld.mcap build/saw-coarse/flux.mcap build/saw-coarse/slag.mcap \
  build/saw-coarse/heat.mcap build/saw-coarse/report.html
