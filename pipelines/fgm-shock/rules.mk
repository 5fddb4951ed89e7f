# fgm-shock: three discs of alumina and zirconia cooled by a jet of nitrogen, from 1023, 1073 and 1123 K.

.PHONY: fgm-shock
fgm-shock: build/fgm-shock/disc-1023.mcap build/fgm-shock/disc-1073.mcap build/fgm-shock/disc-1123.mcap ## thermal shock of a graded disc, figs 12 to 17

build/fgm-shock/disc-1023.mcap: pipelines/fgm-shock/disc-1023.json $(BIN)/heatsph
	$(RERUN) $@ $^ -- $(BIN)/heatsph run pipelines/fgm-shock/disc-1023.json --out $@ $(MACHINE)

build/fgm-shock/disc-1073.mcap: pipelines/fgm-shock/disc-1023.json pipelines/fgm-shock/disc-1073.patch.json \
  $(BIN)/heatsph
	$(RERUN) $@ $^ -- $(BIN)/heatsph run pipelines/fgm-shock/disc-1023.json \
	  --patch pipelines/fgm-shock/disc-1073.patch.json --out $@ $(MACHINE)

build/fgm-shock/disc-1123.mcap: pipelines/fgm-shock/disc-1023.json pipelines/fgm-shock/disc-1123.patch.json \
  $(BIN)/heatsph
	$(RERUN) $@ $^ -- $(BIN)/heatsph run pipelines/fgm-shock/disc-1023.json \
	  --patch pipelines/fgm-shock/disc-1123.patch.json --out $@ $(MACHINE)
