# saw-speed: half a submerged arc weld at four speeds on particles of 1 mm, on the bed of saw-coarse.

.PHONY: saw-speed
saw-speed: programs build/gmaw-600a/arc.mcap build/saw-coarse/bed.mcap ## a submerged arc weld at 2.5 to 10 mm/s: bead and slag over speed (an hour)
	$(SWEEP_RUN) pipelines/saw-speed/sweep.json
