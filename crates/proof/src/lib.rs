//! Poses and motions proved by interval arithmetic.

pub mod certify;
mod krawczyk;
mod not_proved;

pub use certify::{
    Cell, Certificate, CertifiedMotion, Certifier, Gap, Subdivision, certify_motion, certify_pose,
};
pub use not_proved::NotProved;
