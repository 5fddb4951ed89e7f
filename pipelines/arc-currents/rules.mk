# arc-currents: one gas metal arc at five currents; `make -j2 arc-currents THREADS=1` runs them side by side.

.PHONY: arc-currents
arc-currents: build/arc-currents/report.html ## a gas metal arc in argon from 100 to 500 A, with voltage, heat and wire feed over current

ARC_CURRENTS := 100 200 300 400 500

build/arc-currents/%.mcap: pipelines/gmaw-300a/arc.json pipelines/arc-currents/coarse.patch.json \
  pipelines/arc-currents/%.patch.json build/gases/argon.mcap $(BIN)/arcfvm always
	$(RERUN) $(BIN)/arcfvm run pipelines/gmaw-300a/arc.json \
	  --patch pipelines/arc-currents/coarse.patch.json --patch pipelines/arc-currents/$*.patch.json \
	  --input gas=build/gases/argon.mcap --out $@ $(MACHINE)

build/arc-currents/report.html: $(ARC_CURRENTS:%=build/arc-currents/%.mcap) $(BIN)/report always
	$(RERUN) $(BIN)/report page --study arc-currents --out $@ \
	  $(foreach current,$(ARC_CURRENTS),--arc $(current)=build/arc-currents/$(current).mcap)

.PRECIOUS: build/arc-currents/%.mcap build/arc-currents/report.html
