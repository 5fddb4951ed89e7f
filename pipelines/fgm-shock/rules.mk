# fgm-shock: three discs of alumina and zirconia cooled by a jet of nitrogen, from 1023, 1073 and 1123 K.

.PHONY: fgm-shock
fgm-shock: build/fgm-shock/report.html ## thermal shock of a graded disc from three temperatures, with its report

build/fgm-shock/disc-1023.mcap: pipelines/fgm-shock/disc-1023.json $(BIN)/heatsph always
	$(RERUN) $(BIN)/heatsph run pipelines/fgm-shock/disc-1023.json --out $@ $(MACHINE)

build/fgm-shock/disc-1073.mcap: pipelines/fgm-shock/disc-1023.json pipelines/fgm-shock/disc-1073.patch.json \
  $(BIN)/heatsph always
	$(RERUN) $(BIN)/heatsph run pipelines/fgm-shock/disc-1023.json \
	  --patch pipelines/fgm-shock/disc-1073.patch.json --out $@ $(MACHINE)

build/fgm-shock/disc-1123.mcap: pipelines/fgm-shock/disc-1023.json pipelines/fgm-shock/disc-1123.patch.json \
  $(BIN)/heatsph always
	$(RERUN) $(BIN)/heatsph run pipelines/fgm-shock/disc-1023.json \
	  --patch pipelines/fgm-shock/disc-1123.patch.json --out $@ $(MACHINE)

build/fgm-shock/report.html: build/fgm-shock/disc-1023.mcap build/fgm-shock/disc-1073.mcap \
  build/fgm-shock/disc-1123.mcap $(call certificate,fgm-shock) $(BIN)/report always
	$(RERUN) $(BIN)/report heat --study fgm-shock --out $@ \
	  --frames 1023=build/fgm-shock/disc-1023.mcap --frames 1073=build/fgm-shock/disc-1073.mcap \
	  --frames 1123=build/fgm-shock/disc-1123.mcap $(call certified,fgm-shock)

.PRECIOUS: build/fgm-shock/disc-1023.mcap build/fgm-shock/disc-1073.mcap build/fgm-shock/disc-1123.mcap build/fgm-shock/report.html
