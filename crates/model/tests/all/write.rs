//! A model written as a file reads back the same.
#![allow(clippy::unwrap_used)]

use std::path::{Path, PathBuf};

use kempe_model::{Checked, Diagnostic, Model, STARTERS};

fn rendered(found: &[Diagnostic], text: &str) -> String {
    found
        .iter()
        .map(|d| d.render_plain("written", text))
        .collect()
}

/// Writes the model, reads it, and writes it again.
fn reads_back(name: &str, checked: &Checked) {
    let model = &checked.model;
    let file = model.to_toml();
    let again = Model::from_toml(&file.toml, "other", &mut file.tables.files())
        .unwrap_or_else(|found| panic!("{name}: {}\n{}", rendered(&found, &file.toml), file.toml));
    assert!(
        again.model.same_as(model),
        "{name}: {}\n{model:#?}\n{:#?}",
        file.toml,
        again.model
    );
    assert_eq!(
        again.model.to_toml(),
        file,
        "{name}: what is written is written again"
    );
    let codes = |found: &[Diagnostic]| {
        let mut codes: Vec<&str> = found.iter().map(|d| d.code).collect();
        codes.sort_unstable();
        codes.dedup();
        codes
    };
    let before = codes(&checked.warnings);
    for code in codes(&again.warnings) {
        assert!(
            before.contains(&code),
            "{name}: new warning {}",
            rendered(&again.warnings, &file.toml)
        );
    }
}

fn files_in(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|p| p.extension().is_some_and(|e| e == "toml"))
        .collect();
    files.sort();
    files
}

/// The models of a folder that read; tables that are not there are made up.
fn models(folder: &str) -> Vec<(String, Checked)> {
    let mut models = Vec::new();
    for path in files_in(folder) {
        let Ok(text) = std::fs::read_to_string(&path) else {
            continue;
        };
        let mut tables = |name: &str| match std::fs::read_to_string(path.with_file_name(name)) {
            Ok(text) => Ok(text),
            Err(_) => match name {
                "measured.csv" => Ok("t [s];angle\n0.5;10\n0.7;20\n1;25\n2;20\n".to_owned()),
                "card.csv" => Ok("p [bar],phi [deg]\n1,0\n50,360\n2,400\n1,719\n".to_owned()),
                "plain.csv" => Ok("time,force\n0,10\n1,20\n".to_owned()),
                _ => Err("no such file".to_owned()),
            },
        };
        let name = path.display().to_string();
        if let Ok(checked) = Model::from_toml(&text, "", &mut tables) {
            models.push((name, checked));
        }
    }
    models
}

#[test]
fn every_example_reads_back() {
    for (folder, least) in [
        ("../../examples/gallery", 10),
        ("../../examples/seeds", 8),
        ("tests/good", 7),
        // the warnings
        ("tests/bad", 8),
    ] {
        let models = models(folder);
        assert!(models.len() >= least, "{folder}: {}", models.len());
        for (name, checked) in models {
            reads_back(&name, &checked);
        }
    }
}

#[test]
fn every_starter_reads_back() {
    for s in STARTERS {
        let checked = Model::from_toml(s.text, s.name, &mut |_| Err(String::new())).unwrap();
        reads_back(s.name, &checked);
    }
}

/// Everything that the language says and the examples do not, with expressions over parameters where there may be any.
const EVERYTHING: &str = r#"
title = "\"Every\" \\ word é"
units = { length = "in", angle = "rad", force = "kN", torque = "kN m", pressure = "bar", power = "kW", mass = "lb" }
gravity = ["g0", "-80 deg"]

[parameters]
b = "ratio * a + 0.5 in"
ratio = 2.5
neg = -3
a = "2 in"
tilt = "atan2(3 mm, 40 mm) + 10 deg * 2 - -(1 rad)"
g0 = "9.81 m/s^2"
root = "sqrt(a) * sqrt(2 mm) * 3"
odd = "(2 * sqrt(a))^2 * 1.5"
spin = "ratio^ratio * 60 rpm"
area = "pi/4 * (8 mm)^2"
third = "(a^3)^(1/3) + a^2 / (1 mm)"

[links]
plate = { E = "right of B -> C", B-E = 7, B-C = "b - 1 mm", C-E = "max(3 in, a, 80 mm)", P = ["1 in", "tilt"], center = "E", mass = "2 kg" }
frame = { A = [0, 0], D = [7.0, 0], S = [-3, "-a"], U = [-9, -10], G = [-9, -16], H = [30, -16], E1 = [3, 0], F1 = [3, 30] }
crank = { A-B = "a", bar = { width = "20 mm", thickness = "a/10", density = "7850 kg/m^3" } }
"élan" = { D-C = 4.5, mass = "ratio * 1 kg", inertia = "0.01 kg m^2", center = ["a/2", "-0.1 in"] }
lever = { S-T = 8, linear_density = "1 kg/m" }
sun = { S-K = 2 }
wheel = { U-V = 2 }
bar = { R = [0, 0], W = [8, 0], mass = 1 }
slide = { Q = [0.5, 0], mass = 2, inertia = 0 }
ram = { X1 = [0, 0], Y1 = [1, 1], Y1-Z1 = 2, X1-Z1 = 2, Z1 = "left of X1 -> Y1", Z1-N1 = 2, N1-X1 = 2, N1 = "left of Z1 -> X1" }
tail = { A-X1 = 3 }
rod = { X1-Q = 6 }
two = { B-M = 3 }
foot = { U-L = 2 }
loose = { Y9-N9 = 3, X9-Y9 = 3, X9 = [1, 2], X9-N9 = 4, N9 = "left of X9 -> Y9" }

[joints]
slot = { pin = "M", on = "S -> T" }
bore = { slider = "slide", at = "Q", on = "E1 -> F1", angle = "-tilt" }
rigid = { weld = ["lever", "sun"], angle = "30 deg" }
mesh = { gears = ["sun", "wheel"], teeth = ["a", "4 in"], internal = true, phase = "tilt" }
guide = { slider = "bar", at = "R", on = "G -> H" }
steer = { rack = "bar", pinion = "wheel", radius = "b/4", side = "right", offset = -1 }

[drives]
motor = { turns = "crank", from = "tilt", law = [ { dwell = "0.1 s" }, { rise = "ratio * 10 deg", in = "0.2 s", by = "3-4-5" }, { fall = 0.5, speed = "-spin" }, { to = "tilt", acceleration = "3 rad/s^2" } ] }
lift = { cylinder = "Y1-G", from = "a + 10 in", to = 15, speed = "ratio * 1 in/s" }
feed = { slides = "slide", at = 2.125 }
swing = { turns = "ram", relative_to = "tail", law = { table = "measured.csv", time = "t", value = "angle" } }
turner = { turns = "foot", speed = -1, to = -3 }

[assembly]
C = "left of B -> D"
Q = { near = ["3 in", "a"] }
M = "right of B -> S"
bar = { near = "-tilt" }

[loads]
hook = { force = [0, "-100 N * ratio"], at = "P" }
wind = { force = ["50 N", "30 deg + angle(crank)"], at = "C", on = "élan" }
tool = { force = ["-20 N s/m * speed(C)", "1 N * time / 1 s"], at = "C", axes = "plate" }
brake = { torque = "-0.2 N m s * angular_speed(crank)", on = "crank", against = "plate" }
gas = { force = [{ table = "card.csv", over = "angle(crank) * 2", argument = "phi", value = "p", factor = "-area", period = "720 deg" }, "40 deg"], at = "B" }
gas2 = { torque = { table = "card.csv", over = "time * 3", factor = "ratio * 1 N m/bar", argument = "time", value = "p" }, on = "lever" }
gas3 = { force = [{ table = "card.csv", over = "x(C)", argument = "x", value = "p", factor = "sqrt(area) * a" }, 0], at = "B" }

[masses]
weight = { on = "crank", at = [-1, "-a"], mass = "2 kg" }
bob = { at = "E", mass = 0.5 }

[springs]
back = { between = "S-P", stiffness = "2 N/mm * ratio", free = "30 mm", preload = "5 N", acts = "tension", stops = ["none", "a + 300 mm"], stop_stiffness = "500 N/mm" }
strut = { between = "S-C", stiffness = 0, preload = "-300 N" }
door = { links = ["frame", "élan"], stiffness = "3 N m/rad", free = "-90 deg", preload = "ratio * 1 N m", stops = ["-tilt", 4], stop_stiffness = "1 N m/deg" }

[dampers]
closer = { between = "S-P", damping = 0, closing = "200 N s/m" }
hinge = { links = ["frame", "élan"], damping = "0.1 N m s" }

[friction]
B = { coefficient = 0.1, radius = "a/10", viscous = "0.001 N m s", static = 0.15, stribeck = "1 mm/s" }
bore = { viscous = "50 N s/m", drag = "3 N" }
all = { coefficient = "ratio / 100", radius = "4 mm" }

[clearance]
B = { radial = "a/1000", on = ["crank", "two"] }
U = { radial = "20 um", on = "foot" }
bore = { radial = 0 }
slot = { radial = "ratio * 1 um" }
all = { radial = "10 um" }

[cylinders]
lift = { bore = "80 mm", rod = "ratio * 10 mm", supply = 180, relief = "210 bar", back = "5 bar", flow = "20 L/min", friction = "100 N", count = 2, oil = { bulk_modulus = "ratio * 1 GPa", hose_modulus = "4000 bar", wall_modulus = 60000, volume = ["1 L", "a^3"], closed = "a", stroke = 12, valve = ["switch(top) * ratio", { table = "card.csv", over = "time", argument = "time", value = "x", factor = "1 / (1 m)" }], flow = "40 L/min", drop = "35 bar", damping = "1 N s/mm", leakage = "0.1 L/min/bar", start = ["ratio * 1 bar", -0.5] } }

[motors]
motor = { curve = [["0 rpm", "12 N m"], ["spin * 10", "0 N m"]], throttle = "1 - switch(bottom) * time / 3 s" }

[switches]
top = { on = "y(P) <= ratio * a", off = "bore_pressure(lift) > 20 bar + ring_pressure(lift)", starts = "on" }
bottom = { on = "switch(top) >= 0.5" }
teeth = { on = "angle(crank) >= tilt", every = "tilt * ratio" }

[measures]
m1 = "x(P) + y(P) - x(P, plate) + y(P, crank) + m9"
m2 = "angle(crank) - angle(plate, crank) + angle(A -> B) + angle(A, B, C)"
m3 = "distance(A, C) + distance(P, A -> D) + travel(bore) + travel(slot) + length(lift) + travel(slide)"
m4 = "transmission_angle(C, B, D)"
m5 = "speed(P) + rate(a) + rate(x(P)) + d(x(P), motor) * rate(motor)"
m6 = "acceleration(P) + rate(x(P), 2) + rate(3 mm, 2)"
m7 = "angular_speed(crank) * 2 + rate(time) * 3 rad/s"
m8 = "angular_acceleration(crank) * time"
m9 = "instant_center_x(plate) + instant_center_y(plate, crank) + 1 / curvature(P) + curvature_center_x(P) + curvature_center_y(P) + path_length(P)"
n1 = "mechanical_advantage(2 * y(P), motor) * y(P) / x(P)"
n2 = "torque(motor) + reaction_moment(bore) + shaking_moment + reduced_load(motor) + capacity(motor) + spring_force(door) + damper_force(hinge) + load(brake)"
n3 = "force(lift) + reaction(B) + reaction(B, crank) + reaction(bore) + reaction(mesh, sun) + reaction_x(B) + reaction_y(C, plate) + reaction_along(B, crank) + reaction_across(bore, slide)"
n4 = "reaction_angle(B) / 2"
n5 = "pressure(lift)"
n6 = "power(motor) * 2"
n7 = "kinetic_energy + potential_energy"
n8 = "shaking_force + shaking_force_x - -shaking_force_y + capacity(lift) + reduced_load(lift) + spring_force(back) + damper_force(closer) + load(hook) + load_x(hook) + load_y(tool) + force(feed)"
n9 = "reduced_mass(lift) / reduced_mass(motor)"
o1 = "min(x(P)) + max(x(P), 3 mm, -a) + mean(x(P)) + range(x(P)) + stroke(slide) + stroke(lift)"
o2 = "at(x(P), motor, -30 deg) + at(x(P), time, a / (1 in) * 1 s) + at(y(P), lift, -1.5)"
o3 = "time_ratio(2 * angle(crank)) + time_ratio(5 mm)"
o5 = "rate(rate(5 mm * d(angle(plate), motor)))"
o6 = "time"
o7 = "-motor"
o8 = "hypot(x(P), 3 mm) * exp(ratio) * ln(ratio) * asin(0.5) * cos(tilt) * ratio^2 * (2 * ratio)^-0.5 * abs(neg)"
o9 = "3 mm"
p1 = "bore_pressure(lift) - rate(ring_pressure(lift)) * 2 s + switch(top) * 1 bar"

[studies.turn]
kind = "motion"
step = "1 ms * ratio"
columns = ["m1", " rate(m1) ", "at(x(P), motor, 30 deg)"]
plot = ["m1", ["m3", "x(P)"], "path(P)"]
circuit = true
[studies.loads]
kind = "forces"
rows = 25
plot = ["hodograph(B, crank)", "hodograph(bore)"]
[studies.quiet]
kind = "balance"
on = ["crank", "élan"]
radius = "a"
[studies.hang]
kind = "balance"
goal = "statics"
on = ["crank"]
radius = 2
rows = 10
[studies.assist]
kind = "spring"
spring = "door"
drive = "motor"
wanted = "ratio * 1 N m * sin(motor)"
stiffness = [0, "ratio * 1 N m/rad"]
preload = ["none", "200 N m"]
[studies.worn]
kind = "clearance"
rates = "turning"
rows = 25
columns = ["m1", "n3"]
plot = ["m1", "hodograph(bore)"]
[studies.play]
kind = "clearance"
model = "continuous"
[studies.swing]
kind = "synthesize"
task = "dead-centres"
swing = "2 * 30 deg"
time_ratio = 1.2
rocker = "40 mm"
coupler = "41 mm"
keep = 3

[studies.stroke]
kind = "synthesize"
task = "dead-centres"
stroke = "80 mm"
offset = "9 mm"
accept = ["min(transmission_angle) >= 35 deg"]
rank = "-link_ratio"
columns = ["crank_length"]

[studies.rest]
kind = "synthesize"
task = "dwell"
point = "C"
drive = "motor"
dwell = "tilt"
swing = "30 deg"
pivots_in = [[-50, "-a"], [50, 50]]
accept = ["stir <= 0.1 deg"]

[studies.slide]
kind = "synthesize"
task = "dwell"
point = "C"
drive = "motor"
dwell = "40 deg"
output = "slider"
stroke = "a"

[studies.others]
kind = "synthesize"
task = "cognates"
point = "C"
drive = "motor"

[studies.platform]
kind = "synthesize"
task = "cognates"
point = "C"
drive = "motor"
parallel = true
columns = ["turn"]

[studies.generated]
kind = "synthesize"
task = "function"
linkage = "slider-crank"
pairs = [[10, "20 mm", 0.5, 0.1], [20, 30]]
zeros = ["free", "2 mm"]

[studies.guide]
kind = "synthesize"
task = "motion"
linkage = "slider-crank"
poses = [[0, 0, "0 deg"], ["a + 12 mm", 6, "tilt"], [20, 18, "55 deg"]]
crank = { moving = ["11 mm", "30 deg"], fixed_on = [[0, 5], [1, "a"]] }
rocker = { moving_on = [["2 * a", 5], [1, "a"]], along = "90 deg" }
pivots_in = [[-50, "-a"], [50, 50]]

[studies.guides]
kind = "synthesize"
task = "motion"
poses = [[0, 0, "0 deg"], [12, 6, 20]]
crank = { fixed_on = [[0, 5], [1, 6]], moving = [1, 2] }
pins_in = [[-50, 0], [50, 50]]

[studies.modes]
kind = "vibrations"
[studies.swings]
kind = "vibrations"
release = ["lift"]
at = { lift = "a + 60 mm" }
equilibrium = false
[studies.over]
kind = "vibrations"
release = ["lift"]
rows = 12
[studies.grid]
kind = "sweep"
over = "loads"
vary = { a = ["10 mm", "2 * ratio * 5 mm"], tilt = { from = "1 deg", to = "3 deg", count = 5 } }
columns = ["max(x(C))"]
plot = ["x(C)", "path(P)"]
[studies.pairs]
kind = "sweep"
over = "loads"
combine = "one at a time"
vary = { a = { by = "7 %" }, tilt = { by = "ratio * 0.1 deg" } }
[studies.pieces]
kind = "tolerance"
over = "loads"
vary = { a = "0.1 mm", tilt = { normal = "0.1 deg" }, ratio = { normal = "7 %" }, area = { between = ["-1 mm^2", 0] } }
limits = ["range(y(C)) >= 1 mm", "reaction(B) <= 2 kN"]
samples = 5000
seed = 3
[studies.best]
kind = "optimize"
over = "loads"
vary = { a = ["10 mm", "200 mm"], tilt = { only = ["1 deg", "2 deg"] }, ratio = { between = [1, 9], step = 0.5 } }
minimize = ["max(reaction(B))", "range(x(C))"]
maximize = "min(y(C))"
subject_to = "min(transmission_angle(C)) >= 20 deg"
method = "cma-es"
designs = 700
"#;

#[test]
fn every_word_of_the_language_reads_back() {
    let mut tables = |name: &str| match name {
        "measured.csv" => Ok("t [s];angle\n0.5;10\n0.7;20\n1;25\n2;20\n".to_owned()),
        _ => Ok(
            "p [bar],phi [deg],time [s],x [mm]\n1,0,0,0\n50,360,0.3,1\n2,400,1,2\n1,719,2,5\n"
                .to_owned(),
        ),
    };
    let checked = Model::from_toml(EVERYTHING, "", &mut tables)
        .unwrap_or_else(|found| panic!("{}", rendered(&found, EVERYTHING)));
    reads_back("everything", &checked);
    let file = checked.model.to_toml();
    for part in [
        "motor = { turns = \"crank\", from = \"tilt\"",
        "{ rise = \"ratio * 10 deg\"",
        "crank = { A-B = \"a\", ",
        "E = \"right of B -> C\"",
    ] {
        let shown = &file.toml;
        assert!(shown.contains(part), "{part} in {shown}");
    }
}
