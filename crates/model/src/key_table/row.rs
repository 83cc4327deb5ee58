//! How a row of the table is made: keys, kinds, and what keys take.

use kempe_units::Dimension as D;

use crate::keys::{Key, Kind, Named, Need, Quantity, Sign, Takes};
use Takes as T;

pub(super) const fn words<W: Copy, const N: usize>(of: &[(&'static str, W); N]) -> [&'static str; N] {
    let mut words = [""; N];
    let mut i = 0;
    while i < N {
        words[i] = of[i].0;
        i += 1;
    }
    words
}

/// The first word of a choice.
pub(crate) fn word_of<W: PartialEq>(words: &[(&'static str, W)], of: &W) -> &'static str {
    words.iter().find(|(_, known)| known == of).map_or("", |(word, _)| word)
}

type Word = &'static str;

/// A key that must be there.
pub(super) const fn must(name: Word, takes: Takes, example: Word, about: Word) -> Key {
    Key { name, takes, need: Need::Required, example, about }
}

/// A key that may be left out.
pub(super) const fn may(name: Word, takes: Takes, example: Word, about: Word) -> Key {
    Key { name, takes, need: Need::Optional, example, about }
}

/// A key of which one must be there.
pub(super) const fn one_of(name: Word, takes: Takes, example: Word, about: Word) -> Key {
    Key { name, takes, need: Need::OneOf, example, about }
}

pub(super) const fn kind(what: Word, name: Word, example: Word, about: Word, groups: &'static [&'static [Key]]) -> Kind {
    Kind { what, name, groups, points: &[], alone: None, example, about }
}

pub(super) const fn value(dimension: D, turning: D, sign: Sign) -> Takes {
    T::Value(Quantity { dimension, turning, sign })
}

pub(super) const fn any(dimension: D) -> Takes {
    value(dimension, dimension, Sign::Any)
}

pub(super) const fn positive(dimension: D) -> Takes {
    value(dimension, dimension, Sign::Positive)
}

pub(super) const fn not_negative(dimension: D) -> Takes {
    value(dimension, dimension, Sign::NotNegative)
}

pub(super) const LINK: T = T::Name(Named::Link);
pub(super) const POINT: T = T::Name(Named::Point);
pub(super) const COLUMN: T = T::Name(Named::Column);
pub(super) const PLACE: T = T::Pair(D::LENGTH);
pub(super) const ANGLE: T = any(D::ANGLE);
pub(super) const TENSION: T = value(D::FORCE, D::TORQUE, Sign::Any);
pub(super) const fn stiffness(sign: Sign) -> Takes {
    value(D::STIFFNESS, D::TORSIONAL_STIFFNESS, sign)
}
pub(super) const DAMPING: T = value(D::DAMPING, D::TORSIONAL_DAMPING, Sign::NotNegative);
pub(super) const COORDINATE: T = value(D::LENGTH, D::ANGLE, Sign::Any);
pub(super) const SPEED: T = value(D::SPEED, D::ANGULAR_SPEED, Sign::Any);
pub(super) const ACCELERATION: T = value(D::ACCELERATION, D::ANGULAR_ACCELERATION, Sign::Any);
pub(super) const MEASURES: T = T::AnyOf(&[T::Measure, T::List(&T::Measure, 0)]);

pub(super) const DRIVE: T = T::Name(Named::Drive);
pub(super) const END: T = T::AnyOf(&[COORDINATE, T::Words(NONE)]);

/// Where there is no bound.
pub(super) const NONE: &[&str] = &["none"];
