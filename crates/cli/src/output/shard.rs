//! The share that one of several machines has of a sweep's parts.

/// One of several machines that share a sweep: every `of`-th part from the first on that is its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Shard {
    /// Which one, from 1.
    pub own: usize,
    /// How many there are.
    pub of: usize,
}

impl Shard {
    /// From `2/4`.
    ///
    /// # Errors
    ///
    /// What is expected, in words.
    pub fn parse(text: &str) -> Result<Self, String> {
        let wanted = || "write which of how many, such as 2/4".to_owned();
        let (own, of) = text.split_once('/').ok_or_else(wanted)?;
        let number = |text: &str| text.trim().parse::<usize>().map_err(|_| wanted());
        let shard = Self {
            own: number(own)?,
            of: number(of)?,
        };
        match (1..=shard.of).contains(&shard.own) {
            true => Ok(shard),
            false => Err(wanted()),
        }
    }

    /// Whether a part is its own.
    pub(super) fn has(self, part: usize) -> bool {
        part % self.of == self.own - 1
    }
}

impl std::fmt::Display for Shard {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.own, self.of)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_are_one_of_several() {
        assert_eq!(Shard::parse("2/4"), Ok(Shard { own: 2, of: 4 }));
        for wrong in ["", "2", "0/4", "5/4", "1/0", "a/b", "2/4/8", "-1/2"] {
            assert!(Shard::parse(wrong).is_err(), "{wrong}");
        }
        let shards: Vec<Shard> = (1..=3).map(|own| Shard { own, of: 3 }).collect();
        for part in 0..20 {
            assert_eq!(shards.iter().filter(|shard| shard.has(part)).count(), 1);
        }
    }
}
