//! `tilebind completions`.

use clap::{Arg, Args, Command, CommandFactory, ValueHint};
use clap_complete::Shell;

use super::{Arguments, Failure, print};

/// Only Bash would otherwise offer options in place of files.
const FILES_BEFORE_OPTIONS: &[u8] = include_bytes!("completions.bash");

/// Print shell completions
#[derive(Args)]
#[command(after_help = "\
Example:
  tilebind completions bash > ~/.local/share/bash-completion/completions/tilebind")]
pub struct Completions {
    /// The shell
    shell: Shell,
}

impl Completions {
    pub fn run(self) -> Result<(), Failure> {
        let mut text = Vec::new();
        let mut program = hinted(Arguments::command());
        clap_complete::generate(self.shell, &mut program, "tilebind", &mut text);
        if self.shell == Shell::Bash {
            text.extend(FILES_BEFORE_OPTIONS);
        }
        print(&String::from_utf8_lossy(&text))
    }
}

/// The program with a hint for every value, so that a shell offers files for paths, folders for
/// results, and nothing for numbers.
fn hinted(program: Command) -> Command {
    let hint = |argument: Arg| {
        let hint = match argument.get_value_hint() {
            _ if !argument.get_action().takes_values() => return argument,
            ValueHint::AnyPath if argument.get_id() == "out" => ValueHint::DirPath,
            ValueHint::AnyPath => ValueHint::FilePath,
            ValueHint::Unknown => ValueHint::Other,
            known => known,
        };
        argument.value_hint(hint)
    };
    program.mut_subcommands(|command| command.mut_args(hint))
}
