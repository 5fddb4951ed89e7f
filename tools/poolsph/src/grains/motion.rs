//! The motion of grains: steps within a step of the run.

use artefact::Frame;
use contact::{Contact, Friction, Grain, Normal, Rolling};
use particles::{ID, Set};
use run::Fault;
use run::property::OutOfRange;
use shapes::frame::dot;
use steps::{Figure, Limit};

use super::bounds::{Doing, Setting};
use super::columns::STATE;
use super::crowd::{self, Crowd};
use super::depth::{Depth, Reckoned};
use super::gone::Gone;
use super::heat::Heat;
use super::laid::{self, Laid};
use super::law::{Law, Laws};
use super::lists::Lists;
use super::memory::Memory;
use super::metal::Metal;
use super::moving::Moving;
use super::neighbours::Neighbours;
use super::parameters::{BoundsScene, Parameters, RestScene};
use super::sleep::{Sleep, depth};
use super::walls::{self, Walls};
use super::{MASS, RADIUS, VELOCITY, pairs};
use crate::stage::{Stage, StageError};
use crate::state::State;

/// The motion of grains.
pub struct Motion {
    pub(super) law: Law,
    pub(super) friction: Option<Friction>,
    pub(super) rolling: Option<Rolling>,
    pub(super) setting: Setting,
    pub(super) zeta: f64,
    pub(super) walls: Walls,
    pub(super) bounds: Option<BoundsScene>,
    until: Option<RestScene>,
    /// How long no grain has been faster than at rest \[s\].
    pub(super) quiet: f64,
    pub(super) lists: Lists,
    pub(super) sleep: Option<Sleep>,
    /// Rows that may not sleep.
    pub(super) stirred: Vec<u32>,
    /// States of the grains before heat changed them.
    pub(super) states: Vec<u8>,
    /// Lists made since rows were last put in order.
    pub(super) listings: f64,
    pub(super) crowd: Crowd,
    pub(super) moving: Moving,
    pub(super) memories: [Vec<Memory>; 2],
    pub(super) doing: Doing,
    begun: bool,
    restored: Option<Vec<f64>>,
    /// Contacts of the bed that the run begins with.
    pub(super) laid: Option<Laid>,
    pub(super) lost: [f64; 2],
    pub(super) steps: f64,
    /// Into how many steps of its own the last step was divided.
    parts: u64,
    pub(super) heat: Option<Heat>,
    pub(super) metal: Option<Metal>,
}

/// Lists that are made until rows are put in order anew.
const LISTINGS: f64 = 20.0;

impl Motion {
    /// The motion of the grains of `set` as the scene has it.
    ///
    /// # Errors
    /// A formula that cannot be read.
    pub fn new(scene: &Parameters, set: &Set, heat: Option<Heat>) -> Result<Self, Fault> {
        let law = scene.contact.law();
        let zeta = law.damping_ratio();
        let setting = Setting::of(scene, set.column(&MASS), set.column(&RADIUS));
        let drives = scene.bodies.iter().enumerate().map(|(i, body)| {
            let velocity = body.driven_m_s.as_ref();
            let curves = velocity.map(|v| walls::curves(v, &format!("/bodies/{i}/driven_m_s")));
            curves.transpose()
        });
        let drives = drives.collect::<Result<_, _>>()?;
        let gravity = scene.gravity_m_s2.unwrap_or_default();
        let speeds = set.column(&VELOCITY).iter().map(|u| dot(*u, *u));
        Ok(Self {
            law,
            friction: scene.contact.friction(),
            rolling: scene.contact.rolling(),
            setting,
            zeta,
            walls: Walls::new(&scene.walls, setting.radii)?,
            bounds: scene.bounds,
            until: scene.until,
            quiet: 0.0,
            lists: Lists::new(scene.contact.rolling.is_some()),
            sleep: scene.sleep.map(Sleep::new),
            stirred: Vec::new(),
            states: Vec::new(),
            listings: 0.0,
            crowd: Crowd::default(),
            moving: Moving::new(gravity, scene.inertia_factor, drives),
            memories: [Vec::new(), Vec::new()],
            doing: Doing {
                slack: setting.pair(zeta),
                deepest: 0.0,
                fastest: speeds.fold(0.0, f64::max).sqrt(),
            },
            begun: false,
            restored: None,
            laid: None,
            lost: [0.0; 2],
            steps: 0.0,
            parts: 1,
            heat,
            metal: None,
        })
    }

    /// With metal beside the grains.
    #[must_use]
    pub fn beside(self, metal: Option<Metal>) -> Self {
        Self { metal, ..self }
    }

    /// Forces of the start, or lists as they were when a checkpoint was written.
    fn begin(&mut self, set: &mut Set, time: f64) -> Result<(), OutOfRange> {
        self.begun = true;
        if let Some(saved) = self.restored.take() {
            self.relist_as_saved(&saved);
            return Ok(());
        }
        self.walls.begin(time)?;
        self.moving.begin(time)?;
        if let Some(laid) = &self.laid {
            self.memories = [laid.between.clone(), laid.at_walls.clone()];
            if let Some(metal) = &mut self.metal {
                metal.memories.clone_from(&laid.on_metal);
            }
            self.list_with_memories();
        }
        self.put_in_order(set);
        self.list_metal();
        self.walls.spread(&self.moving.grains);
        self.act(0.0, true);
        self.lie();
        Ok(())
    }

    /// Forces and moments of all contacts after a step of `step` \[s\], the `last` within a step of the run or another.
    fn act(&mut self, step: f64, last: bool) {
        match self.law {
            Law::Linear(normal) => self.act_by(normal, step, last),
            Law::Hertz(normal) => self.act_by(normal, step, last),
        }
    }

    fn act_by<N: Normal + Copy + Sync>(&mut self, normal: N, step: f64, last: bool) {
        let friction = self.friction;
        let contact = Contact { normal, friction };
        let (contact, rolling) = (&contact, self.rolling);
        let laws = Laws { contact, rolling };
        let rows = self.moving.grains.len();
        self.moving.force.resize(rows, [0.0; 3]);
        self.moving.moment.resize(rows, [0.0; 3]);
        let Moving {
            grains,
            force,
            moment,
            ..
        } = &mut self.moving;
        let depth = Depth::of(depth(&self.sleep), last);
        let seen = Reckoned { grains, depth };
        pairs::act(&mut self.lists, seen, laws, step, [force, moment]);
        let at_walls = self.walls.act(seen, laws, step);
        self.walls.add([force, moment], depth);
        let in_metal =
            (self.metal.as_mut()).map_or(0.0, |metal| metal.act(seen, laws, step, [force, moment]));
        let overlaps = self.lists.chunks.iter().map(|chunk| chunk.deepest);
        self.doing.deepest = overlaps.fold(at_walls.max(in_metal), f64::max);
    }

    /// One step to `time` \[s\], of which `left` \[s\] are left then in the step of the run. Gives the length of the step that
    /// follows, if its prediction is made, and how far grains have gone with it.
    fn step(
        &mut self,
        time: f64,
        step: f64,
        left: f64,
        predicted: Option<Gone>,
    ) -> Result<Option<(f64, Gone)>, OutOfRange> {
        let gone = match predicted {
            Some(gone) => gone,
            None => self
                .moving
                .predict(step, depth(&self.sleep), self.crowd.leads()),
        };
        self.walls.drift(time, step)?;
        let driven = self.moving.drive(time, step)?;
        if self.strayed(gone.far.max(driven)) || gone.far.is_nan() {
            self.list();
        }
        // What is driven or glued goes its own way.
        let way = if self.moving.drives() {
            f64::INFINITY
        } else {
            gone.way
        };
        if let Some(metal) = &mut self.metal {
            metal.predict(step);
            if metal.strayed(&self.moving.grains, way) {
                self.list_metal();
            }
        }
        self.moving.turn();
        self.act(step, left <= 0.0);
        if self.parts.is_multiple_of(crowd::STEPS) {
            self.count_contacts();
        }
        // By the speeds of the step before, which one step hardly changes.
        let next = (left > 0.0 && !self.moving.drives()).then(|| self.part(left));
        let (depth, leads) = (depth(&self.sleep), self.crowd.leads());
        let (fastest, gone) = self.moving.correct(step, next, depth, leads);
        if let Some(metal) = &mut self.metal {
            metal.correct(step);
        }
        self.doing.fastest = if fastest.is_nan() {
            fastest
        } else {
            fastest.max(self.walls.fastest())
        };
        self.steps += 1.0;
        if let Some(sleep) = &mut self.sleep {
            sleep.count(self.moving.grains.len());
        }
        Ok(next.map(|next| (next, gone)))
    }

    /// Heat of a step of `dt` \[s\] between grains and with metal; who has melted or set wakes.
    fn conduct(&mut self, set: &mut Set, state: &mut State, dt: f64) -> Result<(), StageError> {
        let Some(heat) = &mut self.heat else {
            return Ok(());
        };
        if self.sleep.is_some() {
            self.states.clear();
            self.states.extend(set.column(&STATE));
        }
        let around = Neighbours {
            lists: &self.lists,
            walls: &self.walls,
            metal: self.metal.as_mut(),
            depth: depth(&self.sleep),
        };
        let warmed = heat.advance(set, around, state, dt);
        self.stir_changed(set);
        warmed
    }
}

impl Stage for Motion {
    fn name(&self) -> &'static str {
        "grains"
    }

    fn limit(&self, _: &State) -> Option<Limit> {
        let motion = self.limit();
        let conduction =
            (self.heat.as_ref()).map(|heat| Limit::dividing("grain_conduction", heat.limit));
        conduction
            .filter(|limit| limit.seconds < motion.seconds)
            .or(Some(motion))
    }

    fn follows(&self, _: &State) -> f64 {
        // Grains step by their own limits, whatever the step of the run.
        f64::INFINITY
    }

    fn advance(&mut self, state: &mut State, dt: f64) -> Result<(), StageError> {
        let Some(mut set) = state.grains.take() else {
            return Ok(());
        };
        self.moving.take(&mut set);
        if let Some(metal) = &mut self.metal {
            let grains = &self.moving.grains;
            let all =
                (self.heat.as_ref()).is_some_and(|heat| heat.wants_all(state.step, state.stride));
            metal.see(state, grains, depth(&self.sleep), all);
            metal.take(state, grains, self.doing.fastest, dt);
        }
        let mut march = || -> Result<(), OutOfRange> {
            if !self.begun {
                self.begin(&mut set, state.time)?;
            }
            if self.listings >= LISTINGS {
                self.put_in_order(&mut set);
            }
            self.list_metal();
            self.walls.spread(&self.moving.grains);
            self.count_contacts();
            let (mut done, mut next) = (0.0, None);
            self.parts = 0;
            while done < dt && !self.doing.fastest.is_nan() {
                self.parts += 1;
                let left = dt - done;
                let step = next.map_or_else(|| self.part(left), |(step, _): (f64, Gone)| step);
                // The last is what is left, to the bit.
                done = if step < left { done + step } else { dt };
                let predicted = next.map(|(_, gone)| gone);
                next = self.step(state.time + done, step, dt - done, predicted)?;
            }
            Ok(())
        };
        let marched = march();
        self.turn_in(dt);
        let still = self
            .until
            .is_some_and(|rest| self.doing.fastest < rest.speed_m_s);
        self.quiet = if still { self.quiet + dt } else { 0.0 };
        if let Some(metal) = &mut self.metal {
            metal.give(state, dt);
        }
        self.leave(&mut set);
        let diverged = self.diverged(state);
        self.moving.put(&mut set, depth(&self.sleep));
        let warmed = match &marched {
            Ok(()) => self.conduct(&mut set, state, dt),
            Err(_) => Ok(()),
        };
        if let Some(metal) = &mut self.metal {
            metal.put_aside(depth(&self.sleep));
        }
        state.grains = Some(set);
        marched.map_err(|what| StageError::Data(what.to_string()))?;
        diverged.map_or(warmed, Err)
    }

    fn parts(&self) -> u64 {
        self.parts
    }

    fn ends(&self) -> bool {
        self.until.is_some_and(|rest| self.quiet >= rest.held_s)
    }

    fn leaves(&self, state: &State) -> Option<(&'static str, Frame)> {
        let set = state.grains.as_ref()?;
        self.until?;
        let contacts = self.touching(set.column(&ID), state);
        Some((laid::CHANNEL, laid::frame(&contacts)))
    }

    fn warnings(&self) -> Vec<String> {
        self.told()
    }

    fn figures(&self) -> Vec<Figure> {
        let figure = |name, unit, value| Figure { name, unit, value };
        let mut figures = vec![
            figure("grain_overlap", "m", self.doing.deepest),
            figure("grain_speed", "m/s", self.doing.fastest),
            figure("grain_steps", "1", self.steps),
            figure("grain_contacts", "1", self.contacts()),
        ];
        if self.bounds.is_some() {
            let [left, mass] = self.lost;
            figures.push(figure("grains_left", "1", left));
            figures.push(figure("grains_left_kg", "kg", mass));
        }
        if let Some(sleep) = &self.sleep {
            let asleep = sleep.sleeping(self.moving.grains.len());
            figures.push(figure("grain_asleep", "1", asleep as f64));
            let [all, moved] = sleep.shares;
            figures.push(figure("grain_moved_share", "1", moved / all.max(1.0)));
            figures.push(figure("grain_stilled_j", "J", sleep.taken));
        }
        figures.extend(self.heat.iter().flat_map(Heat::figures));
        figures.extend(self.metal.iter().flat_map(Metal::figures));
        figures
    }

    fn bytes(&self) -> usize {
        let grains = size_of::<Grain>() * self.moving.grains.capacity();
        let heat = self.heat.as_ref().map_or(0, Heat::bytes);
        let metal = self.metal.as_ref().map_or(0, Metal::bytes);
        grains + self.lists.bytes() + self.walls.bytes() + heat + metal
    }

    fn save(&self) -> Vec<f64> {
        if self.begun { self.saved() } else { Vec::new() }
    }

    fn restore(&mut self, saved: &[f64]) {
        let metal = self.metal.as_mut();
        let saved = metal.map_or(saved, |metal| metal.detach(saved));
        self.restored = (!saved.is_empty()).then(|| saved.to_vec());
    }
}
