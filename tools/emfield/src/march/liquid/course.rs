//! How far a march of a liquid has come, and what every march keeps of it in a checkpoint.

use artefact::Checkpoint;
use run::Session;
use steps::Legs;

use crate::liquid::borne::Borne;
use crate::liquid::effort::Effort;
use crate::liquid::renew::Renewed;
use crate::liquid::step::Liquid;

/// How far a march has come.
#[derive(Debug, Clone, Default)]
pub(super) struct Course {
    /// Volume at the start \[m3; m2 in a plane\], where it is known and kept.
    pub(super) volume: Option<f64>,
    /// Volume that was found last, and what all moves of the surface have put back \[the same\].
    kept: [f64; 2],
    /// Momentum that points were given so that its sum is kept, all in absolute value \[N s\].
    pub(super) pushed: f64,
    pub(super) effort: Effort,
    /// Steps that were divided.
    pub(super) divided: u64,
    pub(super) taken: u64,
    /// Points that came and merged.
    pub(super) renewed: Renewed,
}

/// Part of the volume that moves of the surface may put back in a march: drops that stretch need some per cent.
const PUT_BACK: f64 = 0.1;

impl Course {
    /// Notes the volume that was found before the surface is moved to put it right, and after.
    pub(super) fn keep(&mut self, before: f64, after: f64) {
        let [found, put_back] = &mut self.kept;
        *found = after;
        if let Some(volume) = self.volume {
            *put_back += volume - before;
        }
    }

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
        if let Some(borne) = &liquid.borne {
            borne.save(checkpoint);
        }
        checkpoint.put_f64("pressure", &liquid.pressure);
        checkpoint.put_f64("stress", &liquid.stress);
        let kept = self
            .volume
            .map(|volume| [volume, self.kept[0], self.kept[1]]);
        let volume: Vec<f64> = kept.into_iter().flatten().collect();
        checkpoint.put_f64("volume", &volume);
        checkpoint.put_f64("pushed", &[self.pushed]);
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
        if let Some(borne) = &mut liquid.borne {
            *borne = Borne::restore(checkpoint)?;
        }
        liquid.pressure = checkpoint.f64("pressure")?;
        liquid.stress = checkpoint.f64("stress")?;
        if let [volume, found, put_back] = checkpoint.f64("volume")?[..] {
            (self.volume, self.kept) = (Some(volume), [found, put_back]);
        }
        self.pushed = checkpoint.f64("pushed")?.first().copied().unwrap_or(0.0);
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
    pub(super) fn close(&self, steps: &Legs, unit: &'static str, session: &mut Session) {
        session.steps(self.taken);
        session.closing("step", "s", steps.longest());
        session.closing("products", "1", self.effort.products as f64);
        session.closing("residual", "1", self.effort.residual);
        if let Some(volume) = self.volume {
            let [found, put_back] = self.kept;
            session.closing("volume", unit, found);
            session.closing("volume_put_back", unit, put_back);
            if let Some(doubt) = self.doubt(volume, unit) {
                session.warn(doubt);
            }
        }
    }

    /// Tells what points were given so that the momentum is kept.
    pub(super) fn tell_momentum(&self, session: &mut Session) {
        session.closing("momentum_put_back", "N s", self.pushed);
    }

    /// What to tell where moves of the surface have put much back.
    fn doubt(&self, volume: f64, unit: &str) -> Option<String> {
        let [_, put_back] = self.kept;
        (put_back.abs() > PUT_BACK * volume).then(|| {
            format!(
                "the march {} {:.1} % of the volume of {volume:.3e} {unit}, which moves of the surface put back evenly: take a \
                 smaller spacing or step",
                if put_back > 0.0 { "lost" } else { "won" },
                100.0 * put_back.abs() / volume
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn volume_that_is_put_back_is_summed_and_told_above_a_tenth() {
        let mut course = Course {
            volume: Some(2.0),
            ..Course::default()
        };
        course.keep(1.99, 2.0);
        course.keep(2.005, 1.999);
        assert!((course.kept[0] - 1.999).abs() < 1e-15 && (course.kept[1] - 0.005).abs() < 1e-15);
        assert_eq!(course.doubt(2.0, "m3"), None);
        course.keep(1.785, 2.0);
        let told = course.doubt(2.0, "m3").unwrap_or_default();
        assert!(
            told.starts_with("the march lost 11.0 % of the volume of 2.000e0 m3"),
            "{told}"
        );
    }
}
