//! A study over swept values: its points are rules of make.
//!
//! `pipelines/STUDY/sweep.json` (`plan`) names what is swept, and says for each stage what changes with it, as a template of a
//! JSON Merge Patch: `"${current}"` stands for the value of the parameter `current`. The values are combined to points
//! (`values`). What a stage is made from at a point hangs on the parameters that its template, its paths, or the stages before it
//! name, and on nothing else: points that share them share its artefact (`points`).
//!
//! Nothing here decides what must run, and nothing schedules. `rules` writes the patches and a makefile whose rules call
//! `pipelines/rerun` as those of a study do: the same words, so the same keys as runs by hand. `here` calls make with it;
//! `slurm` submits arrays of jobs and `queue` a HyperQueue job, each of which makes one file of the same makefile. When all
//! have ended, `judge` looks what was made, has `report sweep` write the page, and tells what failed.

mod check;
pub mod command;
mod files;
mod here;
mod judge;
mod plan;
mod points;
mod queue;
mod rules;
mod slurm;
mod template;
mod values;
