//! A water jet cuts a solid, by smoothed particles.

fn main() -> std::process::ExitCode {
    run::main::<jetsph::JetSph>()
}
