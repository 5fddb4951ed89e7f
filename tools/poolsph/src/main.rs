//! Weld pool and bead by incompressible SPH.

fn main() -> std::process::ExitCode {
    run::main::<poolsph::PoolSph>()
}
