//! The published systems: every digit of the reference tables, through the example files.
#![allow(clippy::unwrap_used, clippy::disallowed_methods)]

mod support;

use kempe_kinematics::{EndReason, Sampler};
use kempe_model::Measure;
use support::Case;

fn example(name: &str) -> Case {
    let path = format!(
        "{}/../../examples/seeds/{name}.toml",
        env!("CARGO_MANIFEST_DIR")
    );
    Case::read(&std::fs::read_to_string(path).unwrap(), name)
}

/// A unit of the last digit written, and never less than 1e-12 relative.
fn tolerance(text: &str) -> f64 {
    let (mantissa, exponent) = text.split_once('e').unwrap_or((text, "0"));
    let digits = mantissa.split_once('.').map_or(0, |(_, d)| d.len()) as i32;
    let exponent: i32 = exponent.parse().unwrap();
    let value: f64 = text.parse().unwrap();
    (1.01 * 10_f64.powi(exponent - digits)).max(1e-12 * value.abs())
}

/// What the measures of a file must be at values of its drive: the first column, times `unit`.
fn table(case: &Case, unit: f64, names: &[&str], factors: &[f64], rows: &str, modulo: &[&str]) {
    let motion = case.must_move();
    let measures: Vec<&Measure> = names
        .iter()
        .map(|n| {
            let found = case.model.measures.iter().find(|m| m.name == *n);
            &found.unwrap_or_else(|| panic!("no measure {n}")).measure
        })
        .collect();
    let mut sampler = Sampler::new(&motion, &measures).unwrap();
    let mut worst = 0.0_f64;
    for row in rows.trim().lines() {
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        let cells: Vec<&str> = cells.into_iter().filter(|c| !c.is_empty()).collect();
        assert_eq!(cells.len(), names.len() + 1, "{row}");
        let at: f64 = cells[0].parse::<f64>().unwrap() * unit;
        let sample = sampler.at_parameter(at);
        assert!(sample.note.is_none(), "at {}: {:?}", cells[0], sample.note);
        assert!(
            sample.closure < 1e-12,
            "at {}: closure {:e}",
            cells[0],
            sample.closure
        );
        for (k, name) in names.iter().enumerate() {
            let wanted: f64 = cells[k + 1].parse().unwrap();
            let mut off = sample.values[k] * factors[k] - wanted;
            if modulo.contains(name) {
                off -= 360.0 * (off / 360.0).round();
            }
            let allowed = tolerance(cells[k + 1]);
            worst = worst.max(off.abs() / allowed);
            assert!(
                off.abs() <= allowed,
                "{name} at {}: {} but {wanted}",
                cells[0],
                sample.values[k] * factors[k]
            );
        }
    }
    assert!(worst > 0.0);
}

const DEG: f64 = std::f64::consts::PI / 180.0;
const TO_DEG: f64 = 1.0 / DEG;
const MM: f64 = 1e3;

/// S1 (Watt-I lock, floating drive): angles and their transfer functions; `det J` in m^4. The reference counts th4 from
/// another turn.
#[test]
fn door_lock() {
    let case = example("door-lock");
    let angle = [TO_DEG; 4];
    let factors: Vec<f64> = angle.into_iter().chain([1.0, 1.0, 1.0]).collect();
    table(
        &case,
        DEG,
        &["th2", "th3", "th4", "th5", "d2", "d4", "det_j"],
        &factors,
        "
-50 | 41.088152717389 | -8.012804950469 | 385.746172548878 | 103.006226834139 | 0.35081410398 | 0.52262320911 | 7.401341942e-03
-40 | 44.960511404576 | -7.132992672706 | 391.309287297818 | 108.140539559423 | 0.42421230071 | 0.58962756056 | 7.963584064e-03
0 | 67.615080859709 | -4.218854839017 | 419.550019760625 | 123.189619041740 | 0.69341124120 | 0.80443949959 | 1.114442595e-02
50 | 107.558852274676 | -2.031009362342 | 463.678020655122 | 134.264957116006 | 0.88327974561 | 0.94676796806 | 1.116305524e-02
110 | 168.666626417666 | -0.273616670051 | 528.143873774254 | 149.567552209299 | 1.34613400077 | 1.40864451860 | 9.780324568e-04
117 | 179.124373904922 | -0.021069129145 | 539.084120818802 | 154.308032455791 | 1.68998960674 | 1.76768262104 | 5.765584714e-05
118 | 180.853412647221 | 0.020534613228 | 540.892644527590 | 155.211847445291 | 1.77002866803 | 1.85140103083 | -5.353402705e-05
125 | 196.503266969257 | 0.399946803662 | 557.267379211446 | 164.975506743242 | 2.96046597429 | 3.09951429070 | -6.482068925e-04",
        &["th4"],
    );
    // The change point, and the rates in time of the given law.
    let motion = case.must_move();
    let change: Vec<f64> = motion.events.iter().map(|e| e.at * TO_DEG).collect();
    assert_eq!(change.len(), 1, "{change:?}");
    assert!(
        (change[0] - 117.512_206_516_641_08).abs() < 1e-11,
        "{change:?}"
    );
    assert_eq!(motion.ends, (EndReason::Covered, EndReason::Covered));
    table(
        &case,
        DEG,
        &["w2", "a2"],
        &[1.0, 1.0],
        "
-40 | 0.3544475158 | 1.1472463344
0 | 1.2955213054 | 2.4582955024
50 | 2.3338178181 | 2.9227332750
110 | 4.4990100637 | 23.1218982357
120 | 6.7932445638 | 84.2649232017
125 | 10.3477940807 | 233.0592778057",
        &[],
    );
}

/// S2 (crank-rocker), both assemblies. The reference's Py at 300 degrees has the wrong sign for this assembly.
#[test]
fn crank_rocker() {
    let case = example("crank-rocker");
    table(
        &case,
        DEG,
        &["p2", "p3", "w2", "w3", "a2", "a3", "px", "py", "vx", "vy"],
        &[TO_DEG, TO_DEG, 1.0, 1.0, 1.0, 1.0, MM, MM, MM, MM],
        "
0 | 51.31781254651 | 102.63562509302 | -0.5 | -0.5 | -0.16813456150 | 0.60048057677 | 35.625 | 19.51561874499 | 9.75780937250 | 12.1875
60 | 26.52779262819 | 97.56221763934 | -0.25784647964 | 0.29159577615 | 0.28619837202 | 0.49967389321 | 32.36794544674 | 28.48630480013 | -14.44144669786 | 4.23250400967
90 | 20.78195158351 | 109.34940784585 | -0.13257269033 | 0.46761489761 | 0.20297810990 | 0.19396966581 | 23.37343725578 | 28.87031176735 | -18.82403890498 | -3.09867945915
180 | 24.14684799650 | 149.24648019190 | 0.25 | 0.25 | 0.31511510835 | -0.41824368927 | 2.8125 | 10.22691760747 | -2.55672940187 | -14.296875
300 | 64.74100332993 | 135.77542834108 | 0.11498933679 | -0.43445291901 | -0.56215304393 | -0.34867752275 | 20.66776883897 | 5.28919577019 | 14.72063322549 | 11.22667966380",
        &[],
    );
    // Rocker 93.583321698472 .. 153.615670250592, time ratio 1.0175, transmission angle between its extremes.
    table(
        &case,
        DEG,
        &["swing", "ratio", "gamma"],
        &[TO_DEG, 1.0, TO_DEG],
        "
0 | 60.032348552120 | 1.017531377944 | 51.317812546511",
        &[],
    );
    table(
        &case,
        DEG,
        &["gamma"],
        &[TO_DEG],
        "
180 | 54.900367804606",
        &[],
    );

    let below = example("crank-rocker-below");
    table(
        &below,
        DEG,
        &["p2", "p3", "w2", "w3", "px", "py"],
        &[TO_DEG, TO_DEG, 1.0, 1.0, MM, MM],
        "
0 | -51.31781254651 | -102.63562509302 | -0.5 | -0.5 | 35.625 | -19.51561874499
300 | -26.52779262819 | -97.56221763934 | -0.25784647964 | 0.29159577615 | 32.36794544674 | -28.48630480013
270 | -20.78195158351 | -109.34940784585 | -0.13257269033 | 0.46761489761 | 23.37343725578 | -28.87031176735
180 | -24.14684799650 | -149.24648019190 | 0.25 | 0.25 | 2.8125 | -10.22691760747
60 | -64.74100332993 | -135.77542834108 | 0.11498933679 | -0.43445291901 | 20.66776883897 | -5.28919577019",
        &["p2", "p3"],
    );
}

/// S2 (level-luffing crane).
#[test]
fn luffing_crane() {
    let case = example("luffing-crane");
    table(
        &case,
        DEG,
        &["x_e", "y_e", "phi", "beta", "dx_e", "dy_e", "moment"],
        &[1.0, 1.0, TO_DEG, TO_DEG, 1.0, 1.0, 1.0],
        "
37.86 | 24.9439508829 | 9.2515310444 | -18.2766198974 | 17.9538442121 | -18.4646930929 | -2.9522570931 | -295225.7093100464
68.75 | 8.9592435764 | 9.1531215707 | -79.7795518480 | 44.7228624775 | -52.7143951657 | 1.1052825339 | 110528.2533926607",
        &[],
    );
    table(
        &case,
        DEG,
        &["drop"],
        &[1.0],
        "
50 | 0.124461032",
        &[],
    );
}

/// S2 (steering linkage): the force ratio.
#[test]
fn steering_linkage() {
    table(
        &example("steering-linkage"),
        DEG,
        &["ratio"],
        &[1.0],
        "
150 | 6.708970457",
        &[],
    );
}

/// S3 (offset slider-crank at 250 rad/s).
#[test]
fn slider_crank() {
    let case = example("slider-crank");
    table(
        &case,
        DEG,
        &["t2", "s", "w2", "v", "a2", "a"],
        &[TO_DEG, MM, 1.0, MM, 1.0, MM],
        "
30 | 100.0915332495733 | 235.5011075633157 | -34.7640217491889 | 13728.30814008131 | -14838.17397207581 | -1500749.120637815
60 | 94.30122230467036 | 259.2050028069861 | -59.44893677779251 | 8123.820754250232 | -8314.903056503061 | -3721405.732950088
90 | 86.4508491025104 | 267.0972328061609 | -68.5839207299757 | -891.5909694896841 | -291.7443305732674 | -4583436.536790853
120 | 78.53264813935868 | 255.6044719805296 | -60.48897272272497 | -9712.914611173768 | 7988.587297365916 | -3531789.463694166
150 | 72.60060204965731 | 229.1411288489145 | -35.86735621125742 | -14701.45820476589 | 15127.88127230541 | -1104694.220711491
210 | 72.60060204965731 | 171.6411288489145 | 35.86735621125742 | -10196.77215403673 | 15127.88127230541 | 2489055.779288509
270 | 86.4508491025104 | 152.0972328061609 | 68.5839207299757 | 891.5909694896841 | -291.7443305732674 | 2604063.463209147
300 | 94.30122230467036 | 159.6120813717756 | 59.44893677779251 | 6251.179245749768 | -8314.903056503061 | 2503151.856750564
330 | 100.0915332495733 | 178.0011075633157 | 34.7640217491889 | 11169.9222187213 | -14838.17397207581 | 2093000.879362185",
        &[],
    );
    table(
        &case,
        DEG,
        &["t2", "s", "v", "a2", "a"],
        &[TO_DEG, MM, MM, 1.0, MM],
        "
0 | 102.233999555815 | 205.2309674488721 | 14375 | -17510.75894964676 | 779228.7732592808
180 | 70.3840208645948 | 197.8124111374208 | -14375 | 18167.46471738526 | 1280806.262575661",
        &[],
    );
    table(
        &case,
        DEG,
        &["stroke"],
        &[MM],
        "
30 | 115.2390340889153",
        &[],
    );
    table(
        &case,
        DEG,
        &["ratio"],
        &[1.0],
        "
30 | 1.0236610988",
        &[],
    );
}

/// S4 (tractor hitch on its cylinder).
#[test]
fn tractor_hitch() {
    let case = example("tractor-hitch");
    table(
        &case,
        1.0,
        &["phi3", "phi4", "phi5", "phi6", "phi7"],
        &[TO_DEG; 5],
        "
.380 | -24.907171907568 | -69.874720238051 | -23.644363415029 | 101.714099413706 | -13.520656730865
.415 | -14.584180089950 | -70.899896105163 | -17.274194987627 | 103.592921277088 | -6.096013875299
.450 | -3.717790741208 | -71.372420782355 | -10.008939605197 | 105.884658315698 | 2.479657673460
.520 | 21.379017646039 | -70.813551932422 | 7.643043160031 | 112.366225589963 | 23.918962967003",
        &[],
    );
    table(
        &case,
        1.0,
        &["y_m", "y_s", "k3", "u53", "u65", "i_m", "i_s", "i_v", "push"],
        &[1.0; 9],
        "
.380 | 0.0590474033 | 0.6021609662 | 5.06085003177 | 0.58099944455 | 0.28669884631 | 2.42416426286 | 2.97536176178 | 3.03594663838 | 29188.2988831
.415 | 0.1527496472 | 0.7170083937 | 5.25761612617 | 0.64712318780 | 0.30378468002 | 2.92397596489 | 3.58101718083 | 3.59583164733 | 35129.7785439
.450 | 0.2635783524 | 0.8528058889 | 5.60952503245 | 0.68600361606 | 0.32798623278 | 3.41062923363 | 4.18385034769 | 4.18625105806 | 41043.5719108
.520 | 0.5397008986 | 1.1943176577 | 7.19146519961 | 0.70842265934 | 0.41365511844 | 4.54440241022 | 5.68703032981 | 6.02494079783 | 55789.7675354",
        &[],
    );
    table(
        &case,
        1.0,
        &["rise", "tilt"],
        &[1.0, TO_DEG],
        "
.4 | 0.480653495 | 10.652126176",
        &[],
    );
}
