//! A recording as a Parquet file: doubles without gaps, in plain encoding, not compressed. That part of the format is small enough to be written out;
//! numbers of a simulation hardly compress. Units are in the file's metadata under `units`, as JSON.
//!
//! `"PAR1"`, for each column its pages (a header in Thrift, then the doubles), the file's metadata in Thrift, its length, `"PAR1"`. Source: the
//! specification of the format, apache/parquet-format.

mod thrift;

use serde_json::{Map, Value};

use super::columns::Column;
use thrift::Struct;

const MAGIC: &[u8; 4] = b"PAR1";

// Numbers of the format's enumerations.
const DOUBLE: i32 = 5;
const REQUIRED: i32 = 0;
const PLAIN: i32 = 0;
const RLE: i32 = 3;
const UNCOMPRESSED: i32 = 0;
const DATA_PAGE: i32 = 0;

/// Values of a page: a megabyte.
const PAGE: usize = 1 << 17;

/// Where a column stands in the file.
struct Chunk {
    start: usize,
    bytes: usize,
}

/// The file's bytes. All columns are of the same length.
pub(super) fn bytes(columns: &[Column]) -> Vec<u8> {
    let mut out = MAGIC.to_vec();
    let chunks: Vec<Chunk> = columns.iter().map(|c| chunk(&mut out, &c.values)).collect();
    let metadata = metadata(columns, &chunks).end();
    let length = metadata.len() as u32;
    out.extend(metadata);
    out.extend(length.to_le_bytes());
    out.extend(MAGIC);
    out
}

fn chunk(out: &mut Vec<u8>, values: &[f64]) -> Chunk {
    let start = out.len();
    // An empty column has one empty page.
    let pages = if values.is_empty() { vec![values] } else { values.chunks(PAGE).collect() };
    for page in pages {
        let (size, count) = ((page.len() * 8) as i32, page.len() as i32);
        let data = Struct::default().i32(1, count).i32(2, PLAIN).i32(3, RLE).i32(4, RLE);
        out.extend(Struct::default().i32(1, DATA_PAGE).i32(2, size).i32(3, size).nested(5, data).end());
        out.extend(page.iter().flat_map(|x| x.to_le_bytes()));
    }
    Chunk { start, bytes: out.len() - start }
}

fn metadata(columns: &[Column], chunks: &[Chunk]) -> Struct {
    let rows = columns.first().map_or(0, |c| c.values.len()) as i64;
    let root = Struct::default().text(4, "recording").i32(5, columns.len() as i32);
    let leaf = |c: &Column| Struct::default().i32(1, DOUBLE).i32(3, REQUIRED).text(4, &c.title);
    let schema = std::iter::once(root).chain(columns.iter().map(leaf));
    let group = Struct::default()
        .structs(1, columns.iter().zip(chunks).map(|(c, k)| column_chunk(c, k, rows)))
        .i64(2, chunks.iter().map(|k| k.bytes as i64).sum())
        .i64(3, rows);
    let units: Map<String, Value> = columns.iter().map(|c| (c.title.clone(), Value::from(c.unit.clone()))).collect();
    let units = Struct::default().text(1, "units").text(2, &Value::Object(units).to_string());
    Struct::default().i32(1, 1).structs(2, schema).i64(3, rows).structs(4, [group]).structs(5, [units]).text(6, "articulated")
}

fn column_chunk(column: &Column, chunk: &Chunk, rows: i64) -> Struct {
    let (start, bytes) = (chunk.start as i64, chunk.bytes as i64);
    let metadata = Struct::default()
        .i32(1, DOUBLE)
        .i32s(2, &[PLAIN, RLE])
        .texts(3, &[&column.title])
        .i32(4, UNCOMPRESSED)
        .i64(5, rows)
        .i64(6, bytes)
        .i64(7, bytes)
        .i64(9, start);
    Struct::default().i64(2, start).nested(3, metadata)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn column(title: &str, values: &[f64]) -> Column {
        Column { title: title.into(), unit: "s".into(), values: values.into() }
    }

    #[test]
    fn the_doubles_stand_where_the_metadata_says_and_the_end_finds_the_metadata() {
        let file = bytes(&[column("t", &[0.5, -2.0]), column("q.локоть", &[1e-300, f64::NAN])]);
        assert!(file.starts_with(MAGIC) && file.ends_with(MAGIC));
        let end = file.len() - 8;
        let length = u32::from_le_bytes(file[end..end + 4].try_into().unwrap()) as usize;
        let metadata = &file[end - length..end];
        let found = |part: &[u8]| metadata.windows(part.len()).any(|w| w == part);
        assert!(found("q.локоть".as_bytes()) && found(br#"{"t":"s""#) && found(b"articulated"));
        // Page headers of both columns are 17 bytes: 4 + 17, then two doubles.
        assert_eq!(file[21..37], [0.5_f64.to_le_bytes(), (-2.0_f64).to_le_bytes()].concat());
        assert_eq!(file[37 + 17..][..8], 1e-300_f64.to_le_bytes());
    }

    #[test]
    fn every_number_stands_in_the_file_with_all_its_bits() {
        let doubles = crate::states::exact::doubles();
        let file = bytes(&[column("t", &doubles)]);
        // One page: the magic word, a header of 19 to 23 bytes, the doubles.
        let first = doubles[0].to_le_bytes();
        let start = file.windows(8).position(|w| w == first).unwrap();
        assert!((4 + 17..4 + 24).contains(&start), "{start}");
        let read = file[start..].chunks_exact(8).take(doubles.len()).map(|b| u64::from_le_bytes(b.try_into().unwrap()));
        assert!(read.eq(doubles.iter().map(|x| x.to_bits())));
    }

    #[test]
    fn a_long_column_is_several_pages() {
        let values = vec![1.0; PAGE + 1];
        let file = bytes(&[column("t", &values)]);
        assert!(file.len() > 8 * (PAGE + 1) + 2 * 15);
        assert!(bytes(&[column("t", &[])]).len() < 200);
    }
}
