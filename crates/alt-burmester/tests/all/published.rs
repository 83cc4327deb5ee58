//! Published problems of nine points: how many coupler curves pass them, and which.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use std::ops::ControlFlow;
use std::time::Instant;

use kempe_alt_burmester::{Bounds, Given, Kind, StartSet, State, cognate, real, solve};
use kempe_linear::C;

/// The nine points of C. W. Wampler, A. P. Morgan and A. J. Sommese (1992), as in FourBarLinkages.jl.
const CURVE: [[f64; 2]; 9] = [
    [0.8961867, -0.09802917],
    [1.2156535, -1.18749100],
    [1.5151435, -0.85449808],
    [1.6754775, -0.48768058],
    [1.7138690, -0.30099232],
    [1.7215236, 0.03269953],
    [1.6642029, 0.33241088],
    [1.4984171, 0.74435576],
    [1.3011834, 0.92153806],
];
/// One linkage of each curve through the first: fixed pivots, then moving ones at the first point, computed to 40 digits by other means.
const LINKAGES: [[f64; 8]; 21] = [
    [
        0.195295408,
        -0.061240662,
        3.097717938,
        4.710730220,
        -0.077316299,
        0.331009638,
        -1.369905086,
        0.056180185,
    ],
    [
        -0.473375692,
        -0.245694047,
        1.045047535,
        0.412772761,
        1.256303121,
        0.155084270,
        0.602183356,
        -0.654862479,
    ],
    [
        -0.422691253,
        -0.241860160,
        0.224122552,
        -0.153227558,
        -0.843522056,
        -0.217381264,
        -0.172649430,
        -0.375236787,
    ],
    [
        0.168697952,
        -0.474745788,
        0.199855840,
        -0.282849732,
        -0.001328246,
        -1.075384114,
        -0.027790325,
        -0.874103860,
    ],
    [
        0.182811070,
        -0.431423990,
        1.305000584,
        0.228043953,
        1.272439463,
        0.340400143,
        -4.064819613,
        0.582331586,
    ],
    [
        0.187451800,
        -0.828080300,
        1.388033950,
        -0.082838047,
        0.277866677,
        0.565645384,
        -0.212156824,
        -1.592361403,
    ],
    [
        0.210814906,
        -0.326889301,
        1.397673863,
        0.197323436,
        1.398317043,
        0.249315578,
        6.508098844,
        -2.956626707,
    ],
    [
        0.216524101,
        -0.258125604,
        0.218653620,
        -0.546905333,
        -0.351493578,
        -0.437131503,
        -0.378515090,
        -0.702145316,
    ],
    [
        0.216960252,
        -0.308803852,
        1.500504436,
        0.181627987,
        1.489456500,
        0.152674771,
        3.872609387,
        -2.926130849,
    ],
    [
        0.307186358,
        -0.229518174,
        0.470025369,
        1.085375011,
        0.252159663,
        0.812414676,
        1.489210714,
        1.294420954,
    ],
    [
        0.364931742,
        -0.690590841,
        1.660798438,
        0.037275295,
        1.679575849,
        0.100602393,
        0.526809266,
        2.874925476,
    ],
    [
        0.221886204,
        -0.289617990,
        1.697124134,
        0.085572759,
        1.659905385,
        0.037460694,
        1.973989205,
        -2.680176177,
    ],
    [
        0.328391900,
        -0.747298818,
        1.802796492,
        0.180449239,
        1.673334750,
        -0.148407866,
        0.907747445,
        2.338187783,
    ],
    [
        0.219551649,
        -0.321573039,
        0.568395661,
        -0.819905271,
        -0.920569193,
        -0.516865606,
        -0.427007747,
        -1.066155006,
    ],
    [
        0.557340585,
        -0.854905703,
        1.847341175,
        -0.089349554,
        1.888594655,
        -0.000492009,
        1.652528063,
        2.238986688,
    ],
    [
        0.216591116,
        -0.339587082,
        0.714775774,
        -0.853145352,
        -1.318726276,
        -0.633321633,
        -0.409515375,
        -1.234739211,
    ],
    [
        0.214090635,
        -0.330476536,
        1.716122017,
        -0.407165709,
        2.894183699,
        0.236472936,
        0.453516391,
        -2.361668662,
    ],
    [
        1.080861633,
        -0.837689255,
        1.542108165,
        -0.589402721,
        2.283671762,
        0.702430864,
        2.329531795,
        1.546471636,
    ],
    [
        0.216752112,
        -0.277177958,
        1.937970028,
        -0.364965520,
        2.892173552,
        0.061375072,
        0.459479923,
        -2.097404045,
    ],
    [
        0.234380832,
        -0.220779002,
        2.196661516,
        -0.358058699,
        2.274133935,
        -0.328392150,
        0.431506147,
        -1.889673359,
    ],
    [
        0.235979811,
        -0.214982631,
        1.104304155,
        -1.176141543,
        -1.327009117,
        -0.019431368,
        -0.380580823,
        -1.016498164,
    ],
];
const OVAL: [[f64; 2]; 9] = [
    [0.0, 0.0],
    [0.30, -0.1],
    [0.70, 0.0],
    [0.82, 0.2],
    [0.90, 0.4],
    [0.90, 0.7],
    [0.60, 0.7],
    [0.10, 0.5],
    [0.0, 0.3],
];
const TWO_CIRCLES: [[f64; 2]; 9] = [
    [0.25, 0.0],
    [0.52, 0.10],
    [0.80, 0.70],
    [1.20, 1.00],
    [1.40, 1.30],
    [1.10, 1.48],
    [0.70, 1.40],
    [0.20, 1.00],
    [0.02, 0.40],
];

/// Nine points of a short arc of a coupler curve: singular values of the Jacobian lie eight powers of ten apart at one of its four-bars.
const SHORT_ARC: [[f64; 2]; 9] = [
    [1884.804259906026, -3948.7132880835243],
    [1644.696679647131, -4024.6739480129286],
    [1479.8786215398009, -4051.9728922230956],
    [1228.844832335854, -4052.6626199600696],
    [1074.432713860854, -4025.3288086848215],
    [846.514824915155, -3934.295113493812],
    [727.2949544313232, -3851.2660459951144],
    [618.6480291725594, -3736.772589680364],
    [520.6226768996186, -3548.0758722563533],
];
/// Of another.
const SHORT_ARC_TOO: [[f64; 2]; 9] = [
    [-725.3371864728261, -4236.297045827181],
    [-811.7463966770019, -4188.6535672054915],
    [-873.4427289668149, -4151.932989315306],
    [-976.1028356496364, -4081.2998147306826],
    [-1038.321126022163, -4030.792455322131],
    [-1118.0233167435322, -3954.9227653594407],
    [-1190.7117279734123, -3871.3117690295153],
    [-1247.357237452547, -3792.8805033631033],
    [-1301.3975499107253, -3702.1079850822457],
];
/// And of one shorter still.
const SHORTER_ARC: [[f64; 2]; 9] = [
    [1880.4904684894784, -287.76395757255057],
    [1883.855406326144, -224.1872780024816],
    [1886.3927229888257, -171.09411536514864],
    [1889.5354318469108, -112.5782946729723],
    [1893.3130807588639, -57.87786747370127],
    [1896.9671350567135, -16.726213046617033],
    [1905.4366195029675, 54.00244680597544],
    [1911.5228627625304, 92.80428482641479],
    [1923.5079456196972, 153.44451766600707],
];

fn point([x, y]: [f64; 2]) -> C {
    C::new(x, y)
}

fn given(points: &[[f64; 2]]) -> Given {
    let from = point(points[0]);
    let rest: Vec<C> = points[1..].iter().map(|p| point(*p) - from).collect();
    Given::real(Kind::NinePoints, &rest, &[]).unwrap()
}

fn go_on(_: usize, _: usize) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

fn foci(first: C, s: &State) -> [C; 3] {
    let [x, a, y, b] = [s[0], s[1], s[4], s[5]];
    [a, b, (b * x - a * y) * (x - y).recip()].map(|f| f + first)
}

#[test]
fn three_problems_have_as_many_real_answers_as_published() {
    let start = StartSet::found(Kind::NinePoints).unwrap();
    for (points, finite, count, sum) in [
        (CURVE, 1439, 21, [14.8494037580915, -5.17763614354745]),
        (OVAL, 1441, 45, [20.3451555192636, 23.5268694834621]),
        (TWO_CIRCLES, 1442, 64, [73.8297506063861, 17.727322775489]),
    ] {
        let begin = Instant::now();
        let given = given(&points);
        let solved = solve(&start, &given, &go_on).unwrap();
        let found: Vec<State> = (solved.solutions.iter())
            .filter_map(|s| real(&given, s))
            .collect();
        let mut centroids = C::zero();
        for s in &found {
            let [a, b, c] = foci(point(points[0]), s);
            centroids += (a + b + c).scale(1.0 / 3.0);
        }
        println!(
            "{} finite, {} infinite, {} singular, {} lost; {} real, {:?}, {:.2} s",
            solved.solutions.len(),
            solved.infinite,
            solved.singular,
            solved.lost,
            found.len(),
            centroids,
            begin.elapsed().as_secs_f64()
        );
        assert_eq!(found.len(), count);
        let begin = Instant::now();
        let bounds = Bounds::of(&given);
        let proved: Vec<_> = found.iter().filter_map(|s| bounds.certify(s)).collect();
        println!(
            "{} proved, {:.1} us each",
            proved.len(),
            begin.elapsed().as_secs_f64() * 1e6 / count as f64
        );
        assert_eq!(proved.len(), count);
        for (k, one) in proved.iter().enumerate() {
            assert!(one.contains(&found[k]));
            assert!(proved[..k].iter().all(|other| one.differs(other)));
        }
        assert!((centroids - point(sum)).norm() < 1e-9);
        assert!(
            solved.solutions.len() >= finite,
            "{}",
            solved.solutions.len()
        );
    }
}

/// Badly conditioned ends are neither lost nor taken for complex ones: as many real curves as paths with twice the digits all the way find.
#[test]
fn short_arcs_hide_nothing() {
    let start = StartSet::found(Kind::NinePoints).unwrap();
    for (points, unit, count) in [
        (SHORT_ARC, 1024.0, 119),
        (SHORT_ARC_TOO, 512.0, 48),
        (SHORTER_ARC, 256.0, 3),
    ] {
        let seen = |p: [f64; 2]| p.map(|x| x / unit);
        let given = given(&points.map(seen));
        let solved = solve(&start, &given, &go_on).unwrap();
        assert_eq!(solved.solutions.len(), 1442);
        let found: Vec<State> = (solved.solutions.iter())
            .filter_map(|s| real(&given, s))
            .collect();
        assert_eq!(found.len(), count);
        if points == SHORT_ARC {
            let known = [[-381.1165174, -2879.394641], [342.8538782, -3714.704746]];
            let known = known.map(|p| point(seen(p)));
            let is_it = |s: &State| {
                let foci = foci(point(seen(points[0])), s);
                let near = |k: &C| foci.iter().any(|f| (*f - *k).norm() < 1e-6);
                known.iter().all(near)
            };
            assert!(found.iter().any(is_it));
        }
    }
}

#[test]
fn all_linkages_of_the_first_problem_are_found() {
    let start = StartSet::found(Kind::NinePoints).unwrap();
    let given = given(&CURVE);
    let solved = solve(&start, &given, &go_on).unwrap();
    let mut forms: Vec<[C; 4]> = Vec::new();
    for state in &solved.solutions {
        let Some(mut form) = real(&given, state) else {
            continue;
        };
        for _ in 0..3 {
            let at = |k: usize| form[k] + point(CURVE[0]);
            forms.push([at(1), at(5), at(0), at(4)]);
            forms.push([at(5), at(1), at(4), at(0)]);
            form = cognate(&given, &form);
        }
    }
    assert_eq!(forms.len(), 6 * LINKAGES.len());
    for row in LINKAGES {
        let known: [C; 4] = std::array::from_fn(|k| C::new(row[2 * k], row[2 * k + 1]));
        let off = (forms.iter())
            .map(|form| {
                (0..4)
                    .map(|k| (form[k] - known[k]).norm())
                    .fold(0.0, f64::max)
            })
            .fold(f64::INFINITY, f64::min);
        assert!(off < 2e-9, "{off:e} {row:?}");
    }
}
