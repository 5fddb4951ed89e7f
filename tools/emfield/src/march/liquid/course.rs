//! How far a march of a liquid has come, and what every march keeps of it in a checkpoint.

use artefact::Checkpoint;
use run::Session;

use crate::liquid::effort::Effort;
use crate::liquid::renew::Renewed;
use crate::liquid::step::Liquid;
use crate::march::steps::Steps;

/// How far a march has come.
#[derive(Debug, Clone, Default)]
pub(super) struct Course {
    /// Volume at the start \[m3; m2 in a plane\], where it is known and kept.
    pub(super) volume: Option<f64>,
    pub(super) effort: Effort,
    /// Steps that were divided.
    pub(super) divided: u64,
    pub(super) taken: u64,
    /// Points that came and merged.
    pub(super) renewed: Renewed,
}

impl Course {
    /// Keeps it, and the liquid.
    pub(super) fn save<const D: usize>(&self, liquid: &Liquid<D>, checkpoint: &mut Checkpoint) {
        for (name, vectors) in [
            ("position", &liquid.position),
            ("velocity", &liquid.velocity),
            ("rate", &liquid.rate),
            ("normal", &liquid.normal),
            ("follow", &liquid.follow),
        ] {
            checkpoint.put_f64(name, vectors.as_flattened());
        }
        checkpoint.put_f64("pressure", &liquid.pressure);
        checkpoint.put_f64("stress", &liquid.stress);
        let volume: Vec<f64> = self.volume.into_iter().collect();
        checkpoint.put_f64("volume", &volume);
        let e = &self.effort;
        checkpoint.put_f64("residual", &[e.residual]);
        let counts = [
            self.taken,
            self.divided,
            e.products,
            e.unsolved,
            e.unsettled,
            self.renewed.added,
            self.renewed.merged,
        ];
        checkpoint.put_u64("counts", &counts);
    }

    /// Takes back what [`Course::save`] kept.
    pub(super) fn restore<const D: usize>(
        &mut self,
        liquid: &mut Liquid<D>,
        checkpoint: &mut Checkpoint,
    ) -> artefact::Result<()> {
        for (name, vectors) in [
            ("position", &mut liquid.position),
            ("velocity", &mut liquid.velocity),
            ("rate", &mut liquid.rate),
            ("normal", &mut liquid.normal),
            ("follow", &mut liquid.follow),
        ] {
            *vectors = checkpoint.f64(name)?.as_chunks::<D>().0.to_vec();
        }
        liquid.pressure = checkpoint.f64("pressure")?;
        liquid.stress = checkpoint.f64("stress")?;
        self.volume = checkpoint.f64("volume")?.first().copied();
        let residual = checkpoint.f64("residual")?;
        self.effort.residual = residual.first().copied().unwrap_or(0.0);
        if let [taken, divided, products, unsolved, unsettled, added, merged] =
            checkpoint.u64("counts")?[..]
        {
            (self.taken, self.divided) = (taken, divided);
            self.effort.products = products;
            (self.effort.unsolved, self.effort.unsettled) = (unsolved, unsettled);
            self.renewed = Renewed { added, merged };
        }
        Ok(())
    }

    /// Tells steps, solves and the volume, in its unit, at the end.
    pub(super) fn close(&self, steps: &Steps, unit: &'static str, session: &mut Session) {
        session.steps(self.taken);
        session.closing("step", "s", steps.longest());
        session.closing("products", "1", self.effort.products as f64);
        session.closing("residual", "1", self.effort.residual);
        if let Some(volume) = self.volume {
            session.closing("volume", unit, volume);
        }
    }
}
