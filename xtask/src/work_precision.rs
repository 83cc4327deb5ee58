//! Time beside error: what the same error costs several programs.

/// The program whose time is 1.
const OWN: &str = "Kempe";

/// Runs are compared by what it takes them to stay below these relative errors.
const LEVELS: [f64; 4] = [1e-3, 1e-5, 1e-7, 1e-9];

/// One run of one program.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    case: String,
    peer: String,
    method: String,
    error: f64,
    seconds: f64,
}

/// Runs from lines `case,peer,method,error,seconds` below a heading; what has commas is in quotes.
///
/// # Errors
///
/// The line that is no run.
pub fn read(text: &str) -> Result<Vec<Run>, String> {
    let run = |line: &str| {
        let [case, peer, method, error, seconds] = fields(line).try_into().ok()?;
        Some(Run {
            case,
            peer,
            method,
            error: error.parse().ok()?,
            seconds: seconds.parse().ok()?,
        })
    };
    let lines = text.lines().skip(1);
    lines
        .map(|line| run(line).ok_or_else(|| format!("`{line}` is no run of a benchmark")))
        .collect()
}

/// The fields of a line, without the quotes around them.
fn fields(line: &str) -> Vec<String> {
    let mut fields = vec![String::new()];
    for (k, part) in line.split('"').enumerate() {
        let mut pieces = match k % 2 {
            0 => part.split(',').collect(),
            _ => vec![part],
        }
        .into_iter();
        if let (Some(last), Some(first)) = (fields.last_mut(), pieces.next()) {
            last.push_str(first);
        }
        fields.extend(pieces.map(String::from));
    }
    fields
}

/// The fastest run of a program on a case whose error is at most `level`.
fn fastest<'a>(runs: &'a [Run], case: &str, peer: &str, level: f64) -> Option<&'a Run> {
    let enough = |run: &&Run| run.case == case && run.peer == peer && run.error <= level;
    let right = runs.iter().filter(enough);
    right.min_by(|a, b| a.seconds.total_cmp(&b.seconds))
}

/// Names, each once, in the order in which they come.
fn once<'a>(names: impl Iterator<Item = &'a String>) -> Vec<&'a str> {
    let mut seen: Vec<&str> = Vec::new();
    for name in names {
        if !seen.contains(&name.as_str()) {
            seen.push(name);
        }
    }
    seen
}

/// For every case that a peer has run, every error and every peer: the time of the fastest run that keeps below the error, of Kempe
/// and of the peer, the peer's in parts of Kempe's, and how the peer did it. A dash stands where no run keeps below the error.
pub fn table(runs: &[Run]) -> String {
    let theirs = || runs.iter().filter(|run| run.peer != OWN);
    let peers = once(theirs().map(|run| &run.peer));
    let mut lines = vec![format!(
        "{:<18} {:>7} {OWN:>10} ms  {:<14} {:>10} ms {:>9}  method",
        "", "error <", "peer", "its time", "ratio"
    )];
    for case in once(theirs().map(|run| &run.case)) {
        for level in LEVELS {
            let own = fastest(runs, case, OWN, level);
            for peer in &peers {
                let found = fastest(runs, case, peer, level);
                let ratio = match (own, found) {
                    (Some(own), Some(found)) => format!("{:.2}", found.seconds / own.seconds),
                    _ => "-".into(),
                };
                lines.push(format!(
                    "{case:<18} {level:>7.0e} {:>10} ms  {peer:<14} {:>10} ms {ratio:>9}  {}",
                    milliseconds(own),
                    milliseconds(found),
                    found.map_or("", |run| &run.method)
                ));
            }
        }
    }
    lines
        .iter()
        .map(|line| format!("{}\n", line.trim_end()))
        .collect()
}

fn milliseconds(run: Option<&Run>) -> String {
    run.map_or("-".into(), |run| format!("{:.3}", 1e3 * run.seconds))
}

#[cfg(test)]
mod tests {
    use super::*;

    const RUNS: &str = "case,peer,method,error,seconds
fall,Kempe,tolerance 1e-4,2e-4,0.001
fall,Kempe,tolerance 1e-10,3e-9,0.004
alone,Kempe,tolerance 1e-4,1e-5,0.002
fall,other 1.0,\"alpha, 100 steps\",9e-4,0.010
fall,other 1.0,\"alpha, 1000 steps\",9e-6,0.1
fall,other 1.0,explicit,8e-6,0.05
";

    #[test]
    fn the_fastest_run_that_is_right_enough_counts() {
        let runs = read(RUNS).unwrap();
        assert_eq!(fastest(&runs, "fall", "Kempe", 1e-3), Some(&runs[0]));
        assert_eq!(fastest(&runs, "fall", "other 1.0", 1e-3), Some(&runs[3]));
        assert_eq!(fastest(&runs, "fall", "other 1.0", 1e-5), Some(&runs[5]));
        assert_eq!(fastest(&runs, "fall", "other 1.0", 1e-7), None);
        let shown = table(&runs);
        let words: Vec<Vec<&str>> = (shown.lines())
            .map(|line| line.split_whitespace().collect())
            .collect();
        let known: [&[&str]; 4] = [
            &[
                "fall", "1e-3", "1.000", "ms", "other", "1.0", "10.000", "ms", "10.00", "alpha,",
                "100", "steps",
            ],
            &[
                "fall", "1e-5", "4.000", "ms", "other", "1.0", "50.000", "ms", "12.50", "explicit",
            ],
            &[
                "fall", "1e-7", "4.000", "ms", "other", "1.0", "-", "ms", "-",
            ],
            &["fall", "1e-9", "-", "ms", "other", "1.0", "-", "ms", "-"],
        ];
        assert_eq!(words[1..5], known);
        assert_eq!(words.len(), 5, "a case without peers stands alone already");
    }

    #[test]
    fn what_is_no_run_is_told() {
        for line in [
            "fall,Kempe,fast,1e-3",
            "a, b,Kempe,fast,1e-3,1",
            "fall,Kempe,fast,right,1",
        ] {
            let error = read(&format!("heading\n{line}")).unwrap_err();
            assert!(error.contains(line), "{error}");
        }
    }
}
