//! `sweep`: a study over swept values.

fn main() -> std::process::ExitCode {
    sweep::command::main()
}
