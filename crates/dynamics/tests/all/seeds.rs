//! Published systems against independent numbers.

use crate::support::*;
use kempe_model::{Center, DriveId, ForceMeasure, Place, Statistic};
use kempe_units::Expr;

fn degrees(list: &[f64]) -> Vec<f64> {
    list.iter().map(|d| d.to_radians()).collect()
}

/// The door lock, ideal joints, plates' centres at the mean of their vertices.
#[test]
fn door_lock_with_centroids() {
    let model = model(&example("door-lock"));
    let measures = [
        drive(),
        pin(&model, "O"),
        pin(&model, "A"),
        pin(&model, "B"),
        pin(&model, "D"),
    ];
    let reference = [
        (
            -50.0,
            [
                23.399996244,
                48.3541057,
                59.0536025,
                298.1223376,
                223.1496218,
            ],
        ),
        (
            -40.0,
            [
                26.117811494,
                33.8485167,
                45.2754588,
                281.4649286,
                214.9013412,
            ],
        ),
        (
            0.0,
            [26.980521576, 7.1771298, 9.1292160, 198.0779776, 181.4795255],
        ),
        (
            50.0,
            [2.347887228, 20.3387347, 6.0460614, 83.2990014, 139.7746277],
        ),
        (
            110.0,
            [
                -20.139704658,
                59.6157778,
                58.9374597,
                66.9522174,
                63.4257411,
            ],
        ),
        (
            120.0,
            [
                97.615405120,
                1275.4881271,
                1265.3103477,
                1627.3050745,
                1122.7385261,
            ],
        ),
        (
            125.0,
            [
                628.561690427,
                3347.6384407,
                3322.4131329,
                5927.6012468,
                3073.8058439,
            ],
        ),
    ];
    let at = degrees(&reference.map(|r| r.0));
    for (row, (angle, expected)) in values(&model, &measures, &at).iter().zip(reference) {
        for (k, (found, expected)) in row.iter().zip(expected).enumerate() {
            let digit = if k == 0 { 5.1e-10 } else { 5.1e-8 };
            close(&format!("{k} at {angle}"), *found, expected, digit);
        }
    }
}

#[test]
fn door_lock_vectors_at_zero() {
    let model = model(&example("door-lock"));
    let mut measures = vec![pin(&model, "E"), pin(&model, "G"), pin(&model, "F")];
    for (at, on) in [
        ("O", "bar2"),
        ("A", "plate3"),
        ("B", "plate4"),
        ("D", "plate4"),
    ] {
        measures.extend(pin_on(&model, at, on));
    }
    let expected = [
        109.7442728,
        82.6821927,
        97.4820516,
        -0.6804532,
        7.1448006,
        -0.1208590,
        -9.1284160,
        57.9380293,
        -189.4150733,
        -14.5211633,
        180.8976340,
    ];
    let found = values(&model, &measures, &[0.0]);
    for (k, (found, expected)) in found[0].iter().zip(expected).enumerate() {
        close(&format!("{k}"), *found, expected, 5.1e-8);
    }
}

/// The same with the plates' centres at the midpoints of their sides l3 and l4.
#[test]
fn door_lock_with_midpoints() {
    let mut model = model(&example("door-lock"));
    for (name, length) in [("plate3", 0.43), ("plate4", 0.21)] {
        let at = link(&model, name).index();
        let inertia = model.links[at].inertia.as_mut().expect("mass");
        inertia.center = Center::Place(Place::Cartesian {
            x: number(length / 2.0),
            y: number(0.0),
        });
    }
    let measures = [drive(), pin(&model, "O")];
    let reference = [
        (-50.0, 17.994550818, 9.7342126),
        (0.0, 20.023715090, 39.7613014),
        (50.0, -1.190664279, 47.1504213),
        (90.0, -23.149836041, 53.7803599),
        (125.0, 462.889163930, 2203.9393755),
    ];
    let at = degrees(&reference.map(|r| r.0));
    for (row, (angle, torque, force)) in values(&model, &measures, &at).iter().zip(reference) {
        close(&format!("torque at {angle}"), row[0], torque, 5.1e-10);
        close(&format!("force at {angle}"), row[1], force, 5.1e-8);
    }
}

/// The torque stays smooth through the change point; the pins' loads do not, and the rows say so.
#[test]
fn door_lock_at_its_change_point() {
    let model = model(&example("door-lock"));
    let at = 117.512_206_516_641_08_f64.to_radians();
    let step = 0.002;
    let places: Vec<f64> = (-2..=2).map(|k| at + step * f64::from(k)).collect();
    let rows = rows(&model, &[drive(), pin(&model, "O")], &places);
    let torque: Vec<f64> = rows.iter().map(|r| r.sample.values[0]).collect();
    let fourth = torque[0] - 4.0 * torque[1] + 6.0 * torque[2] - 4.0 * torque[3] + torque[4];
    assert!(fourth.abs() < 1e-3 * torque[2].abs(), "{torque:?}");
    assert!(!rows[2].notes.is_empty(), "{:?}", rows[2]);
    assert!(rows[2].evidence.is_some_and(|e| !(e.condition < 1e8)));
}

/// The hitch lifts a weight by its cylinder: massless links, quasi-static.
#[test]
fn tractor_hitch() {
    let mut model = model(&example("tractor-hitch"));
    let implement = link(&model, "implement").index();
    model.links[implement].inertia = None;
    let load = force("weight", on(&model, "implement", "S"), [0.0, -9810.0]);
    model.actions.loads.push(load);
    let along = |at: &str, on: &str| {
        ask(ForceMeasure::ReactionAlong(kempe_model::JointRef::Pin(
            point(&model, at),
            Some(link(&model, on)),
        )))
    };
    // The upper link pulls or pushes along E -> F, the strut along D -> K; both are two-force bars.
    let measures = [drive(), along("F", "upper"), along("K", "strut")];
    let at = [0.38, 0.415, 0.425, 0.45, 0.52];
    let expected = [
        29188.2988831,
        35129.7785439,
        36793.830407213,
        41043.5719108,
        55789.7675354,
    ];
    let rows = values(&model, &measures, &at);
    for ((row, at), expected) in rows.iter().zip(at).zip(expected) {
        close(
            &format!("force at {at}"),
            row[0],
            expected,
            5.1e-8 * expected.abs() / 3e4,
        );
    }
    // On the implement along EF, on the lower link along DK: the bars themselves feel the opposite.
    close("upper link", -rows[2][1], -10645.348224, 5.1e-7);
    close("strut", -rows[2][2], -29329.742406, 5.1e-7);

    // The work of the cylinder, as the mean force over the even motion.
    let work = Expr::Leaf(kempe_model::Leaf::Over(Statistic::Mean, Box::new(drive())));
    let found = values(&model, &[work], &[0.4])[0][0] * 0.14;
    close("work", found, 5809.057143153, 1e-8);
}

#[test]
fn tractor_hitch_reduced_mass() {
    let model = model(&example("tractor-hitch"));
    let measures = [
        ask(ForceMeasure::ReducedMass(DriveId(0))),
        ask(ForceMeasure::ReducedLoad(DriveId(0))),
    ];
    let row = &values(&model, &measures, &[0.425])[0];
    close("reduced mass", row[0], 14471.153187687, 5.1e-9);
    close("reduced load", row[1], -36793.830407213, 1e-8);
}

#[test]
fn luffing_crane() {
    let model = model(&example("luffing-crane"));
    let tie = ask(ForceMeasure::ReactionAlong(kempe_model::JointRef::Pin(
        point(&model, "B"),
        Some(link(&model, "arms")),
    )));
    // Along the tie rod: its own axes.
    let tie_along = ask(ForceMeasure::ReactionAlong(kempe_model::JointRef::Pin(
        point(&model, "B"),
        Some(link(&model, "tie")),
    )));
    let at = degrees(&[37.86, 68.75, 50.0, 44.0025, 57.035, 67.1916]);
    let rows = values(&model, &[drive(), tie_along, tie], &at);
    // The torque must hold the load up: the opposite of the load's moment.
    close("low", rows[0][0], -295225.7093100464, 1e-7);
    close("high", rows[1][0], 110528.2533926607, 1e-7);
    close("boom", rows[2][0].abs(), 54590.608219, 5.1e-7);
    // The rod feels the opposite of what it does to the jib's arms.
    close("tie rod", -rows[2][1], -186957.804712, 5.1e-7);
    for (row, place) in rows[3..].iter().zip([44.0025, 57.035, 67.1916]) {
        let slope = 1e5 * 40.0; // N m/rad, generous
        close(&format!("zero at {place}"), row[0], 0.0, slope * 1e-4);
    }
}

const CRANK_ROCKER: &str = r#"
[links]
frame   = { A = [0, 0], D = [0.25, 0] }
crank   = { A-B = 0.10, mass = "0.10 kg", inertia = "8.333333333333333e-5 kg m^2", center = "centroid" }
coupler = { B-C = 0.25, mass = "0.25 kg", inertia = "1.3020833333333333e-3 kg m^2", center = "centroid" }
rocker  = { D-C = 0.20, mass = "0.20 kg", inertia = "6.666666666666667e-4 kg m^2", center = "centroid" }
[drives]
motor = { turns = "crank", from = "0 deg", to = "360 deg", speed = "30 rad/s" }
[assembly]
C = "left of B -> D"
"#;

/// The crank-rocker of uniform rods, driven at 30 rad/s.
#[test]
fn crank_rocker_inverse_dynamics() {
    let model = model(CRANK_ROCKER);
    let measures = [
        drive(),
        ask(ForceMeasure::ReducedMass(DriveId(0))),
        ask(ForceMeasure::ReducedLoad(DriveId(0))),
    ];
    let at = degrees(&[0.0, 45.0, 90.0, 180.0, 270.0]);
    let expected = [
        -3.6616583333333343,
        1.3581064989852525,
        0.45574853549863503,
        -0.9966583931291005,
        0.7888708704146018,
    ];
    let rows = values(&model, &measures, &at);
    for ((row, at), expected) in rows.iter().zip(&at).zip(expected) {
        close(
            &format!("torque at {at}"),
            row[0],
            expected,
            1e-12 * expected.abs(),
        );
    }
    close("inertia", rows[2][1], 0.003354798153480122, 1e-16);
    close("load", rows[2][2].abs(), 0.021692599102762028, 1e-14);
}

/// A slider-crank at 5000 rpm without gravity.
#[test]
fn slider_crank_kinetostatics() {
    let text = r#"
[links]
frame  = { A = [0, 0], E = [1, 0] }
crank  = { A-B = 0.05 }
rod    = { B-C = 0.12, mass = "0.21 kg", inertia = "0.00025 kg m^2", center = "centroid" }
slider = { C = [0, 0], mass = "0.14 kg" }
[joints]
bore = { slider = "slider", at = "C", on = "A -> E" }
[drives]
motor = { turns = "crank", from = "0 deg", to = "360 deg", speed = "523.5987755982989 rad/s" }
[assembly]
C = { near = [0.17, 0] }
"#;
    let mut model = model(text);
    no_gravity(&mut model);
    let mut measures = Vec::new();
    measures.extend(pin_on(&model, "C", "rod"));
    measures.extend(pin_on(&model, "B", "rod"));
    measures.push(drive());
    let reference = [
        (0.0, [2718.71047159637, 0.0, -6197.06063378585, 0.0, 0.0]),
        (
            30.0,
            [
                2098.58110084075,
                -999.768527116114,
                -4919.0022797322,
                280.109872870015,
                135.104170281118,
            ],
        ),
        (
            45.0,
            [
                1396.77147160959,
                -1091.14441165858,
                -3462.10110443079,
                73.3933825445738,
                124.998606329397,
            ],
        ),
        (
            90.0,
            [
                -879.613342294326,
                122.678906246034,
                1539.32334901507,
                -1561.99621473823,
                -76.9661674507535,
            ],
        ),
        (180.0, [-1119.46901771615, 0.0, 3398.38808949547, 0.0, 0.0]),
    ];
    let at = degrees(&reference.map(|r| r.0));
    for (row, (angle, expected)) in values(&model, &measures, &at).iter().zip(reference) {
        for (k, (found, expected)) in row.iter().zip(expected).enumerate() {
            close(&format!("{k} at {angle}"), *found, expected, 1e-11 * 6200.0);
        }
    }
    // Extremes over the motion, located between rows.
    let over =
        |statistic, measure| Expr::Leaf(kempe_model::Leaf::Over(statistic, Box::new(measure)));
    let measures = [
        over(Statistic::Max, pin(&model, "C")),
        over(Statistic::Max, pin(&model, "B")),
        over(Statistic::Max, drive()),
        over(Statistic::Min, drive()),
    ];
    let row = &values(&model, &measures, &[0.1])[0];
    close("slider pin", row[0], 2718.710471596374, 1e-8);
    close("crank pin", row[1], 6197.060633785853, 1e-8);
    // The reference is the largest value on a grid of 0.01 degrees.
    close("torque", row[2], 138.5216645, 3e-6);
    close("torque", row[3], -138.5216645, 3e-6);
    let near = values(&model, &[drive()], &degrees(&[34.97, 325.03]));
    close("torque at 34.97", near[0][0], 138.5216645, 5.1e-8);
    close("torque at 325.03", near[1][0], -138.5216645, 5.1e-8);
}
