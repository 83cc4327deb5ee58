//! Parameters set from outside, `--set a=25mm`.
#![allow(clippy::unwrap_used)]

use kempe_model::{Diagnostic, Model};

const FILE: &str = "[parameters]\na = \"20 mm\"\nb = \"2*a\"\nn = 3\n[links]\nframe = { A = [0, 0], D = [\"b\", 0] }\nbar = { A-B = \"a\" }\n";

fn set(given: &[(&str, &str)]) -> Result<Vec<f64>, Vec<Diagnostic>> {
    let given: Vec<(String, String)> = given
        .iter()
        .map(|(n, t)| ((*n).to_owned(), (*t).to_owned()))
        .collect();
    let checked = Model::from_toml_with(FILE, "x", &mut |_| Err(String::new()), &given)?;
    Ok(checked.model.parameter_values())
}

#[test]
fn what_builds_on_it_follows() {
    assert_eq!(set(&[("a", "25 mm")]).unwrap(), [0.025, 0.05, 3.0]);
    assert_eq!(
        set(&[("a", "n * 1 mm"), ("n", "4")]).unwrap(),
        [4.0, 0.004, 0.008]
    );
    assert_eq!(set(&[("a", "1 mm"), ("a", "2 mm")]).unwrap()[0], 0.002);
}

#[test]
fn what_is_wrong_points_at_the_override() {
    let plain = |given: &[(&str, &str)]| {
        set(given)
            .unwrap_err()
            .iter()
            .map(|d| d.render_plain("x.toml", FILE))
            .collect::<String>()
    };
    assert_eq!(
        plain(&[("aa", "3 mm")]),
        "error[unknown-name]: there is no parameter `aa`\n  ┌ --set:1:1\n1 │ aa=3 mm\n  │ ^^ not declared in the file\n  = help: did you mean `a`?\n"
    );
    assert_eq!(
        plain(&[("a", "30 deg")]),
        "error[unit-mismatch]: length expected, found an angle\n  ┌ x.toml:2:5\n2 │ a = \"20 mm\"\n  │     ------- a length\n  ┌ --set a:1:1\n1 │ 30 deg\n  │ ^^^^^^ this is an angle\n  = help: the file says a length: give it like 20 m\n"
    );
    assert!(plain(&[("a", "3 *")]).contains("--set a:1:4"));
    assert!(plain(&[("a", "b")]).contains("cyclic-parameter"));
    assert!(plain(&[("a", "0 mm")]).contains("bad-size"));
}
