//! The files that `kempe new` writes: short, commented, and ready to run.

/// A starter file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Starter {
    /// Its name on the command line.
    pub name: &'static str,
    /// What it shows, in one line.
    pub doc: &'static str,
    /// The file.
    pub text: &'static str,
}

/// All starter files; the first is what a file without a kind starts from.
pub const STARTERS: &[Starter] = &[
    Starter {
        name: "four-bar",
        doc: "a crank-rocker with a coupler curve",
        text: include_str!("starter/four-bar.toml"),
    },
    Starter {
        name: "slider-crank",
        doc: "an engine's crank, rod and piston",
        text: include_str!("starter/slider-crank.toml"),
    },
    Starter {
        name: "six-bar",
        doc: "a crank-rocker whose coupler swings an output lever",
        text: include_str!("starter/six-bar.toml"),
    },
    Starter {
        name: "cylinder",
        doc: "an arm lifted by a hydraulic cylinder, with its force",
        text: include_str!("starter/cylinder.toml"),
    },
    Starter {
        name: "gear-train",
        doc: "two gear meshes one after the other, with the torque",
        text: include_str!("starter/gear-train.toml"),
    },
    Starter {
        name: "generator",
        doc: "a four-bar found from the angles that its rocker should take",
        text: include_str!("starter/generator.toml"),
    },
];

/// The starter file of a name.
pub fn starter(name: &str) -> Option<&'static Starter> {
    STARTERS.iter().find(|s| s.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Model;

    #[test]
    fn every_starter_reads_without_a_word() {
        for s in STARTERS {
            match Model::from_toml(s.text, s.name, &mut |_| Err("no files".to_owned())) {
                Ok(checked) => assert_eq!(checked.warnings, [], "{}", s.name),
                Err(found) => panic!(
                    "{}",
                    found
                        .iter()
                        .map(|d| d.render_plain(s.name, s.text))
                        .collect::<String>()
                ),
            }
        }
        assert_eq!(starter("cylinder").map(|s| s.name), Some("cylinder"));
    }
}
