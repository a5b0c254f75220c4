//! Decoding of numbers in binary files.

/// How a number is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

/// The kind and the byte order of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Number {
    pub(super) kind: Kind,
    pub(super) big_endian: bool,
}

impl Number {
    /// Bytes per number.
    pub(super) fn width(self) -> usize {
        match self.kind {
            Kind::I8 | Kind::U8 => 1,
            Kind::I16 | Kind::U16 => 2,
            Kind::I32 | Kind::U32 | Kind::F32 => 4,
            Kind::I64 | Kind::U64 | Kind::F64 => 8,
        }
    }

    /// Appends the numbers in `bytes` as `f64`; only integers beyond 2^53 are rounded. An incomplete last number is ignored.
    pub(super) fn decode(self, bytes: &[u8], into: &mut Vec<f64>) {
        macro_rules! decode {
            ($t:ty) => {
                into.extend(bytes.as_chunks().0.iter().map(|chunk| {
                    let number = if self.big_endian { <$t>::from_be_bytes(*chunk) } else { <$t>::from_le_bytes(*chunk) };
                    number as f64
                }))
            };
        }
        match self.kind {
            Kind::I8 => decode!(i8),
            Kind::U8 => decode!(u8),
            Kind::I16 => decode!(i16),
            Kind::U16 => decode!(u16),
            Kind::I32 => decode!(i32),
            Kind::U32 => decode!(u32),
            Kind::I64 => decode!(i64),
            Kind::U64 => decode!(u64),
            Kind::F32 => decode!(f32),
            Kind::F64 => decode!(f64),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_orders_and_the_extremes() {
        let decode = |kind, big_endian, bytes: &[u8]| {
            let mut values = Vec::new();
            Number { kind, big_endian }.decode(bytes, &mut values);
            values
        };
        assert_eq!(decode(Kind::I16, false, &[0xfe, 0xff, 1, 2, 9]), [-2.0, 513.0]);
        assert_eq!(decode(Kind::I16, true, &[0xff, 0xfe]), [-2.0]);
        assert_eq!(decode(Kind::U64, true, &[255; 8]), [18446744073709551616.0]);
        assert_eq!(decode(Kind::F32, true, &[0x3f, 0x80, 0, 1]), [1.0000001192092896]);
        assert_eq!(decode(Kind::F64, false, &f64::MIN_POSITIVE.to_le_bytes()), [f64::MIN_POSITIVE]);
        assert_eq!(decode(Kind::I8, false, &[0x80]), [-128.0]);
    }
}
