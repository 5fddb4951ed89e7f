# arc-currents: one gas metal arc at five currents; `make -j2 arc-currents THREADS=1` runs them side by side.

.PHONY: arc-currents
arc-currents: programs ## a gas metal arc in argon from 100 to 500 A, with voltage, heat and wire feed over current
	$(SWEEP_RUN) pipelines/arc-currents/sweep.json
