//! Teeth for the gears and racks of random mechanisms.

use kempe_mechanism::Mechanism;
use kempe_mechanism::constraint::Joint as _;
use kempe_mechanism::structure::Source;
use kempe_model::{Friction, FrictionAt, JointId, JointKind, Model, Scalar, ToothSize, value};
use kempe_units::Expr;

use crate::mechanisms::Rng;

/// Gives the gears and racks of a model a pressure angle and, if at all, friction with this coefficient, wherever their
/// wheels meet. `times` makes a scalar of a number.
pub fn give_teeth(
    model: &mut Model,
    rng: &mut Rng,
    friction: Option<Scalar>,
    mut times: impl FnMut(&mut Rng, f64) -> Scalar,
) -> usize {
    let mechanism = Mechanism::new(model);
    let parameters: Vec<f64> = model.parameter_values();
    let mut count = 0;
    for index in 0..model.joints.len() {
        let id = JointId(index as u32);
        let mut constraints = mechanism.constraints.iter();
        let meet =
            constraints.any(|(c, source)| *source == Source::Joint(id) && c.rubs().is_some());
        let (angle, numbers) = (rng.range(0.2, 0.5), rng.range(8.0, 50.0));
        let teeth = match &mut model.joints[index].kind {
            JointKind::Gears { teeth, .. } if meet => teeth,
            JointKind::Rack { radius, teeth, .. } => {
                let module = 2.0 * value(radius, &parameters) / numbers;
                teeth.size = ToothSize::Module(Some(times(rng, module)));
                teeth
            }
            _ => continue,
        };
        teeth.pressure_angle = Some(times(rng, angle));
        count += 1;
        if let Some(coefficient) = &friction {
            model.actions.friction.push(Friction {
                at: FrictionAt::Joint(id),
                coefficient: coefficient.clone(),
                static_coefficient: None,
                stribeck_speed: None,
                viscous: rng.chance(0.3).then_some(Expr::Const(0.01)),
                drag: None,
                radius: None,
                span: 0..0,
            });
        }
    }
    count
}
