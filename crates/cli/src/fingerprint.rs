//! Whether bytes are the same as they were.

/// FNV-1a (Fowler, Noll, Vo) of 64 bits: tells changes by chance, not by design.
pub fn fnv1a64(bytes: &[u8]) -> u64 {
    continued(NOTHING, bytes)
}

/// The fingerprint of no bytes, from which others go on.
pub const NOTHING: u64 = 0xcbf2_9ce4_8422_2325;

/// The fingerprint of some bytes with more behind them.
pub fn continued(hash: u64, bytes: &[u8]) -> u64 {
    bytes.iter().fold(hash, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_values() {
        // From the authors' list of test vectors.
        assert_eq!(fnv1a64(b""), 0xcbf2_9ce4_8422_2325);
        assert_eq!(fnv1a64(b"a"), 0xaf63_dc4c_8601_ec8c);
        assert_eq!(fnv1a64(b"foobar"), 0x8594_4171_f739_67e8);
        assert_eq!(continued(fnv1a64(b"foo"), b"bar"), fnv1a64(b"foobar"));
    }
}
