//! One file per exact solution.

mod arc_cells;
mod arc_column;
mod arc_electrode;
mod arc_electrons;
mod arc_elenbaas;
mod arc_evaporation;
mod arc_mms;
mod arc_pinch;
mod arc_poiseuille;
mod arc_potential;
mod arc_surface;
mod arc_vapour;
mod arc_wire_joule;
mod dem_bed;
mod dem_conductance;
mod dem_contact;
mod dem_incline;
mod dem_pile;
mod dem_rigid;
mod dem_rolling;
mod dem_shear_loop;
mod dem_silo;
mod dem_wire;
mod em_axisymmetric_sphere;
mod em_bar;
mod em_cylinder_ac;
mod em_dielectric_sphere;
mod em_ellipsoid;
mod em_open;
mod em_planar_az;
mod em_ring_coil;
mod em_saturation;
mod em_sphere_aside;
mod em_sphere_gauge;
mod em_sphere_loops;
mod em_sphere_pair;
mod em_sphere_pull;
mod em_sphere_uniform_ac;
mod em_transient_cylinder;
mod em_transient_gauge;
mod em_transient_sphere;
mod flow_cavity;
mod flow_channel;
mod flow_dam_break;
mod flow_drop;
mod flow_invariance;
mod flow_layers;
mod flow_marangoni;
mod flow_mirror;
mod flow_pressure;
mod flow_sessile;
mod flow_sloshing;
mod flow_spot;
mod flow_taylor_green;
mod fracture_energy;
mod fracture_pull;
mod gas_argon;
mod heat_block_3d;
mod heat_c_t;
mod heat_cylinder_flux;
mod heat_exp_t;
mod heat_exp_t_transient;
mod heat_exp_x;
mod heat_exp_x_transient;
mod heat_patch;
mod heat_robin_square;
mod heat_shock_disc;
mod heat_sin_xy;
mod heat_two_slabs;
mod jet_column;
mod jet_plate;
mod jet_press;
mod jet_still;
mod jet_threshold;
mod liquid_charge;
mod liquid_drop;
mod liquid_field_breakup;
mod liquid_field_drop;
mod liquid_field_march;
mod liquid_flow;
mod liquid_heat;
mod liquid_leaky;
mod liquid_levitation;
mod liquid_rest;
mod liquid_sessile;
mod liquid_split;
mod liquid_stretched;
mod pool_dimple;
mod pool_drop_oscillation;
mod pool_drop_pressure;
mod pool_hydrostatic;
mod pool_plate;
mod pool_rosenthal;
mod pool_similar;
mod pool_stefan;
mod pool_surface_heat;
mod saw_float;
mod saw_layer;
mod saw_slag;
mod solid_cook;
mod solid_patch;
mod solid_plastic;
mod solid_rings;
mod solid_swing;
mod solid_turn;
mod solid_wave;
mod wls_operators;

use crate::case::Case;

/// Every case, in the order in which `make verify` runs them.
#[must_use]
pub fn all() -> Vec<Box<dyn Case>> {
    let mut all = continua();
    all.extend(pools());
    all.extend(grains());
    all.extend(jets());
    all.extend(liquids());
    all
}

/// Grains.
fn grains() -> Vec<Box<dyn Case>> {
    vec![
        Box::new(dem_contact::DemContact),
        Box::new(dem_rolling::DemRolling),
        Box::new(dem_incline::DemIncline),
        Box::new(dem_shear_loop::DemShearLoop),
        Box::new(dem_conductance::DemConductance),
        Box::new(dem_bed::DemBed),
        Box::new(dem_wire::DemWire),
        Box::new(dem_wire::DemCavity),
        Box::new(dem_pile::DemPile),
        Box::new(dem_rigid::DemRigid),
        Box::new(dem_silo::DemSilo),
        Box::new(saw_float::SawFloat),
        Box::new(saw_layer::SawLayer),
        Box::new(saw_slag::SawSlag),
    ]
}

/// Cases of jets and solids.
fn jets() -> Vec<Box<dyn Case>> {
    vec![
        Box::new(fracture_pull::FracturePull),
        Box::new(fracture_energy::FractureEnergy),
        Box::new(jet_column::JetColumn),
        Box::new(jet_plate::JetPlate),
        Box::new(jet_press::JetPress),
        Box::new(jet_still::JetStill),
        Box::new(jet_threshold::JetThreshold),
        Box::new(solid_swing::SolidSwing::BAR),
        Box::new(solid_swing::SolidSwing::PLATE),
        Box::new(solid_patch::SolidPatch),
        Box::new(solid_turn::SolidTurn),
        Box::new(solid_wave::SolidWave),
        Box::new(solid_cook::SolidCook),
        Box::new(solid_plastic::SolidPlastic),
        Box::new(solid_rings::SolidRings),
    ]
}

/// Pools of metal, and its flow.
fn pools() -> Vec<Box<dyn Case>> {
    vec![
        Box::new(pool_dimple::PoolDimple),
        Box::new(pool_drop_oscillation::PoolDropOscillation),
        Box::new(pool_drop_pressure::PoolDropPressure),
        Box::new(pool_hydrostatic::PoolHydrostatic),
        Box::new(pool_plate::PoolPlate),
        Box::new(pool_rosenthal::PoolRosenthal),
        Box::new(pool_similar::PoolSimilar),
        Box::new(pool_stefan::PoolStefan),
        Box::new(pool_surface_heat::PoolSurfaceHeat),
        Box::new(flow_channel::FlowChannel::POISEUILLE),
        Box::new(flow_channel::FlowChannel::COUETTE),
        Box::new(flow_layers::FlowLayers),
        Box::new(flow_marangoni::FlowMarangoni),
        Box::new(flow_pressure::FlowPressure),
        Box::new(flow_cavity::FlowCavity),
        Box::new(flow_taylor_green::FlowTaylorGreen),
        Box::new(flow_sloshing::FlowSloshing),
        Box::new(flow_dam_break::FlowDamBreak),
        Box::new(flow_drop::FlowDrop),
        Box::new(flow_sessile::FlowSessile),
        Box::new(flow_mirror::FlowMirror),
        Box::new(flow_spot::FlowSpot),
        Box::new(flow_invariance::FlowInvariance),
    ]
}

/// Fields.
fn continua() -> Vec<Box<dyn Case>> {
    vec![
        Box::new(arc_cells::ArcCells),
        Box::new(arc_column::ArcColumn),
        Box::new(arc_electrode::ArcElectrode),
        Box::new(arc_electrons::ArcElectrons),
        Box::new(arc_elenbaas::ArcElenbaas),
        Box::new(arc_evaporation::ArcEvaporation),
        Box::new(arc_mms::ArcMms),
        Box::new(arc_pinch::ArcPinch),
        Box::new(arc_poiseuille::ArcPoiseuille),
        Box::new(arc_potential::ArcPotential),
        Box::new(arc_surface::ArcSurface),
        Box::new(arc_vapour::ArcVapour),
        Box::new(arc_wire_joule::ArcWireJoule),
        Box::new(em_dielectric_sphere::EmDielectricSphere),
        Box::new(em_ellipsoid::EmEllipsoid),
        Box::new(em_open::EmOpen),
        Box::new(em_sphere_pull::EmSpherePull),
        Box::new(em_sphere_pair::EmSpherePair),
        Box::new(em_ring_coil::EmRingCoil),
        Box::new(em_cylinder_ac::EmCylinderAc),
        Box::new(em_planar_az::EmPlanarAz),
        Box::new(em_bar::EmBar),
        Box::new(em_saturation::EmSaturation),
        Box::new(em_sphere_uniform_ac::EmSphereUniformAc),
        Box::new(em_sphere_loops::EmSphereLoops),
        Box::new(em_axisymmetric_sphere::EmAxisymmetricSphere),
        Box::new(em_sphere_gauge::EmSphereGauge),
        Box::new(em_sphere_aside::EmSphereAside),
        Box::new(em_transient_cylinder::EmTransientCylinder),
        Box::new(em_transient_gauge::EmTransientGauge),
        Box::new(em_transient_sphere::EmTransientSphere),
        Box::new(gas_argon::GasArgon),
        Box::new(heat_patch::HeatPatch),
        Box::new(heat_exp_x::HeatExpX),
        Box::new(heat_exp_x_transient::HeatExpXTransient),
        Box::new(heat_sin_xy::HeatSinXy),
        Box::new(heat_exp_t::HeatExpT),
        Box::new(heat_c_t::HeatCT),
        Box::new(heat_exp_t_transient::HeatExpTTransient),
        Box::new(heat_block_3d::HeatBlock3d),
        Box::new(heat_robin_square::HeatRobinSquare),
        Box::new(heat_cylinder_flux::HeatCylinderFlux),
        Box::new(heat_two_slabs::HeatTwoSlabs),
        Box::new(heat_shock_disc::HeatShockDisc),
        Box::new(wls_operators::WlsOperators),
    ]
}

/// Drops that swing and rest.
fn liquids() -> Vec<Box<dyn Case>> {
    vec![
        Box::new(liquid_drop::LiquidDrop),
        Box::new(liquid_drop::LiquidDropViscous),
        Box::new(liquid_rest::LiquidRest),
        Box::new(liquid_field_breakup::LiquidFieldBreakup),
        Box::new(liquid_field_drop::LiquidFieldDrop),
        Box::new(liquid_field_march::LiquidFieldMarch),
        Box::new(liquid_charge::LiquidCharge),
        Box::new(liquid_flow::LiquidFlow),
        Box::new(liquid_heat::LiquidHeat),
        Box::new(liquid_leaky::LiquidLeaky),
        Box::new(liquid_levitation::LiquidLevitation),
        Box::new(liquid_sessile::LiquidSessile),
        Box::new(liquid_stretched::LiquidStretched),
        Box::new(liquid_split::LiquidSplit),
    ]
}
