//! The heat balance: what enters, what leaves, part by part.

use crate::case::Case;
use crate::heat::energy::Energy;
use crate::heat::reads::Around;
use crate::heat::sources::Sources;

/// Heat of one electrode by part \[W\].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ElectrodeHeat {
    /// Conducted from the gas.
    pub convection: f64,
    /// Taken up from the arc's radiation.
    pub radiation: f64,
    /// Electrons.
    pub electron: f64,
    /// Ions.
    pub ion: f64,
    /// Surface radiation.
    pub emission: f64,
    /// Vapour.
    pub vapour: f64,
    /// Joule heat within the metal.
    pub joule: f64,
    /// Brought into the gas by emitted electrons; no heat of the metal.
    pub into_gas: f64,
    /// Power of the layer in front of it; no heat of the metal.
    pub layer: f64,
    /// Work function that electrons give it, if it is an anode; part of `electron`.
    pub gained: f64,
    /// Work function that all electrons climb that leave it, if it is a cathode, those that ions take among them.
    pub climbed: f64,
    /// The part of that which the closure of a cathode does not take from it.
    pub ungiven: f64,
}

impl ElectrodeHeat {
    /// Sum of the parts \[W\].
    #[must_use]
    pub fn sum(&self) -> f64 {
        self.convection
            + self.radiation
            + self.electron
            + self.ion
            + self.emission
            + self.vapour
            + self.joule
    }
}

/// All heat of the domain \[W\]; what enters is positive.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Balance {
    /// Joule heat.
    pub joule: f64,
    /// Given sources.
    pub given: f64,
    /// Radiation of the gas.
    pub radiation: f64,
    /// Electrodes.
    pub electrodes: Vec<ElectrodeHeat>,
    /// Carried away by all moving plates.
    pub plate: f64,
    /// With vapour off metal.
    pub vapour: f64,
    /// Radiation taken up by granular flux and slag.
    pub granular: f64,
    /// Through the edges by conduction.
    pub edges: f64,
    /// Sum of the amounts that pass through faces of the edges, for scale.
    pub exchanged: f64,
    /// Through the edges with gas and metal.
    pub flow: f64,
    /// With drops from the wire.
    pub drops: f64,
    /// With electrons into the gas, where they carry heat.
    pub electrons: Option<f64>,
}

impl Balance {
    /// Adds up the present state.
    #[must_use]
    pub fn new(around: Around<'_>, energy: &Energy, sources: &Sources) -> Self {
        let (case, enthalpy) = (around.case, &around.properties.enthalpy);
        let through = energy.edges(around);
        let drops = case
            .wire
            .map_or(0.0, |w| w.drops(case, around.feed, enthalpy));
        let mut electrodes = electrodes(case, energy, sources);
        for (n, one) in electrodes.iter_mut().enumerate() {
            one.joule = joule(around, n);
        }
        Self {
            joule: sources.joule,
            given: sources.given,
            radiation: -sources.emission.iter().sum::<f64>(),
            electrodes,
            plate: -sources.plates.iter().sum::<f64>(),
            granular: sources.granular,
            vapour: sources.vapour,
            edges: through.conduction,
            exchanged: through.scale(),
            flow: through.flow,
            drops: -drops,
            electrons: energy.carried(around),
        }
    }

    /// What enters more than leaves \[W\]: zero where the energy equation holds.
    #[must_use]
    pub fn closure(&self) -> f64 {
        // Conduction from gas to metal stays within the domain.
        let surface = |e: &ElectrodeHeat| e.sum() - e.convection - e.joule + e.into_gas;
        let surfaces: f64 = self.electrodes.iter().map(surface).sum();
        let inner = self.joule + self.given + self.radiation + surfaces;
        let inner = inner + self.vapour + self.granular;
        let known = inner + self.plate + self.edges + self.flow + self.drops;
        known + self.electrons.unwrap_or(0.0)
    }
}

/// Joule heat within the metal of an electrode \[W\].
fn joule(around: Around<'_>, electrode: usize) -> f64 {
    let (Some(potential), case) = (around.potential, around.case) else {
        return 0.0;
    };
    let mut contacts = case.contacts().iter();
    let contact = contacts.find(|c| c.electrode == electrode);
    let material = contact.map(|c| case.material[c.metal]);
    let cells = potential.joule.iter().zip(&case.material);
    let own = cells.filter(|(_, m)| Some(**m) == material);
    own.map(|(joule, _)| joule).sum()
}

/// Heat of every electrode without its Joule heat.
#[must_use]
pub fn electrodes(case: &Case, energy: &Energy, sources: &Sources) -> Vec<ElectrodeHeat> {
    let Some(surfaces) = &case.surfaces else {
        return Vec::new();
    };
    let mut all = vec![ElectrodeHeat::default(); surfaces.electrodes.len()];
    let taken_up = sources.contacts.iter().zip(sources.absorbed());
    for (contact, (found, absorbed)) in surfaces.contacts.iter().zip(taken_up) {
        let one = &mut all[contact.electrode];
        one.convection += (energy.convection(contact) - found.held) * contact.area;
        one.radiation += absorbed * contact.area;
        one.electron += found.parts.electron * contact.area;
        one.ion += found.parts.ion * contact.area;
        one.emission += found.parts.emission * contact.area;
        one.vapour += found.parts.vapour * contact.area;
        one.into_gas += found.into_gas * contact.area;
        one.layer += found.layer * contact.area;
        let electrode = &surfaces.electrodes[contact.electrode];
        let [gained, climbed, ungiven] = electrode.work(found.current, found.emitted);
        one.gained += gained * contact.area;
        one.climbed += climbed * contact.area;
        one.ungiven += ungiven * contact.area;
    }
    all
}
