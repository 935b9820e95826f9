//! Thrift's compact protocol, as far as the metadata of Parquet needs it: structs are written field by field, fields in the order of their numbers.
//!
//! A field is a byte (distance from the last field's number; kind of the value), integers are zigzag varints, texts and lists have their length
//! before them, and a struct ends with a zero. Source: the protocol's specification in the repository of Apache Thrift.

const I32: u8 = 5;
const I64: u8 = 6;
const BINARY: u8 = 8;
const LIST: u8 = 9;
const STRUCT: u8 = 12;

/// A struct that is being written.
#[derive(Clone, Debug, Default)]
pub(super) struct Struct {
    bytes: Vec<u8>,
    last: u8,
}

impl Struct {
    pub(super) fn i32(self, field: u8, value: i32) -> Self {
        self.integer(field, I32, value.into())
    }

    pub(super) fn i64(self, field: u8, value: i64) -> Self {
        self.integer(field, I64, value)
    }

    fn integer(mut self, field: u8, kind: u8, value: i64) -> Self {
        self.head(field, kind);
        varint(&mut self.bytes, zigzag(value));
        self
    }

    pub(super) fn text(mut self, field: u8, value: &str) -> Self {
        self.head(field, BINARY);
        binary(&mut self.bytes, value);
        self
    }

    pub(super) fn nested(mut self, field: u8, value: Self) -> Self {
        self.head(field, STRUCT);
        self.bytes.extend(value.end());
        self
    }

    pub(super) fn structs(mut self, field: u8, values: impl IntoIterator<Item = Self>) -> Self {
        let ended: Vec<Vec<u8>> = values.into_iter().map(Self::end).collect();
        self.list(field, STRUCT, ended.len());
        self.bytes.extend(ended.into_iter().flatten());
        self
    }

    pub(super) fn texts(mut self, field: u8, values: &[&str]) -> Self {
        self.list(field, BINARY, values.len());
        values.iter().for_each(|v| binary(&mut self.bytes, v));
        self
    }

    pub(super) fn i32s(mut self, field: u8, values: &[i32]) -> Self {
        self.list(field, I32, values.len());
        values.iter().for_each(|v| varint(&mut self.bytes, zigzag((*v).into())));
        self
    }

    /// The bytes of the whole struct.
    pub(super) fn end(mut self) -> Vec<u8> {
        self.bytes.push(0);
        self.bytes
    }

    /// Fields come in order and no two are more than 15 apart: so it is in all structs of Parquet that are written here.
    fn head(&mut self, field: u8, kind: u8) {
        debug_assert!(field > self.last && field - self.last <= 15);
        self.bytes.push((field - self.last) << 4 | kind);
        self.last = field;
    }

    fn list(&mut self, field: u8, kind: u8, length: usize) {
        self.head(field, LIST);
        if length < 15 {
            self.bytes.push((length as u8) << 4 | kind);
        } else {
            self.bytes.push(0xf0 | kind);
            varint(&mut self.bytes, length as u64);
        }
    }
}

fn binary(out: &mut Vec<u8>, text: &str) {
    varint(out, text.len() as u64);
    out.extend(text.as_bytes());
}

/// 0, −1, 1, −2, 2, … as 0, 1, 2, 3, 4, …
fn zigzag(x: i64) -> u64 {
    ((x << 1) ^ (x >> 63)).cast_unsigned()
}

/// Seven bits a byte, the lowest first; the top bit says that more follow.
fn varint(out: &mut Vec<u8>, mut x: u64) {
    while x >= 0x80 {
        out.push(x as u8 | 0x80);
        x >>= 7;
    }
    out.push(x as u8);
}

#[cfg(test)]
mod tests {
    use super::Struct;

    #[test]
    fn bytes_are_those_of_the_specification() {
        let inner = Struct::default().i32(1, 150);
        let bytes = Struct::default().i32(1, -1).i64(3, 1).text(4, "ab").nested(6, inner).i32s(7, &[0, 1]).end();
        // zigzag(−1) = 1, zigzag(1) = 2, zigzag(150) = 300 = 0b10_0101100
        assert_eq!(bytes, [0x15, 1, 0x26, 2, 0x18, 2, b'a', b'b', 0x2c, 0x15, 0xac, 0x02, 0, 0x19, 0x25, 0, 2, 0]);
        let long = Struct::default().texts(1, &[""; 20]).end();
        assert_eq!(long[..3], [0x19, 0xf8, 20]);
        // A length from 15 on has bytes of its own.
        let list = |length: usize| Struct::default().i32s(1, &vec![0; length]).end();
        assert_eq!((&list(14)[..3], &list(15)[..4]), (&[0x19, 0xe5, 0][..], &[0x19, 0xf5, 15, 0][..]));
    }
}
