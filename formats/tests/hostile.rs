//! An answer for any bytes, in a short time.

mod corpus;

use articulated_core::description::{JointId, LinkId};
use std::fmt::Write;

use articulated_core::diagnostic::Code;
use articulated_formats::{Options, read};
use corpus::CRANE;

/// xorshift64*, so that a failure can be repeated from its seed.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_f491_4f6c_dd1d)
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }
}

/// Pieces that make a document interesting.
const PIECES: [&[u8]; 24] = [
    b"<",
    b">",
    b"/",
    b"\"",
    b"'",
    b"=",
    b"&",
    b"<!--",
    b"-->",
    b"<![CDATA[",
    b"]]>",
    b"<?",
    b"?>",
    b"<!DOCTYPE",
    b"\0",
    b"\xff",
    b":",
    b"xmlns=\"x\"",
    b"<link name=\"boom\"/>",
    b"</robot>",
    b"&#0;",
    b"nan",
    b"1e309",
    b"\xc2\xb7",
];

fn mutate(bytes: &mut Vec<u8>, random: &mut Random) {
    let at = random.below(bytes.len().max(1)).min(bytes.len());
    match random.below(6) {
        0 => bytes.truncate(at),
        1 => bytes.iter_mut().skip(at).take(1).for_each(|b| *b ^= 1 << random.below(8)),
        2 => bytes.iter_mut().skip(at).take(1).for_each(|b| *b = random.next() as u8),
        3 => drop(bytes.drain(at..(at + random.below(20)).min(bytes.len()))),
        4 => {
            let piece = bytes[at..(at + random.below(60)).min(bytes.len())].to_vec();
            let to = random.below(bytes.len() + 1);
            bytes.splice(to..to, piece);
        }
        _ => drop(bytes.splice(at..at, PIECES[random.below(PIECES.len())].iter().copied())),
    }
}

/// The crane with joints of this crate's own.
fn extended() -> String {
    CRANE
        .replace("type=\"continuous\"", "type=\"universal\"")
        .replace("<axis xyz=\"0 0 1\"/>", "<axis xyz=\"0 0 1\"/><axis2 xyz=\"1 0 0\"/>")
        .replace("type=\"prismatic\"", "type=\"helical\"")
        .replace("<axis xyz=\"1 0 0\"/>", "<axis xyz=\"1 0 0\"/><thread pitch=\"0.01\"/>")
        .replace("type=\"fixed\"", "type=\"spherical\"")
}

#[test]
fn the_extended_crane_is_sound() {
    assert!(answer(extended().as_bytes(), 0));
}

/// Every error has a place and a cause; none is an internal error.
fn answer(bytes: &[u8], seed: u64) -> bool {
    let options = Options { snap_angles: Some(1e-3), ..Options::default() };
    match std::panic::catch_unwind(|| read(bytes, &options)) {
        Ok(Ok(reading)) => {
            assert!(reading.description.root().is_some(), "seed {seed}");
            true
        }
        Ok(Err(problems)) => {
            assert!(!problems.errors.is_empty(), "seed {seed}");
            assert!(problems.errors.iter().all(|e| e.code != Code::Internal), "seed {seed}: {problems}");
            false
        }
        Err(_) => panic!("panic with seed {seed}: {}", String::from_utf8_lossy(bytes)),
    }
}

#[test]
fn mutated_documents_get_an_answer() {
    let mut accepted = 0;
    for seed in 1..=3000 {
        let mut random = Random(0x9e37_79b9_7f4a_7c15_u64.wrapping_mul(seed));
        let mut bytes = if seed % 2 == 0 { CRANE.as_bytes().to_vec() } else { extended().into_bytes() };
        for _ in 0..=random.below(4) {
            mutate(&mut bytes, &mut random);
        }
        accepted += usize::from(answer(&bytes, seed));
    }
    // Both ways are walked.
    assert!((100..2900).contains(&accepted), "{accepted}");
}

#[test]
fn truncated_documents_are_refused() {
    for length in 0..CRANE.trim_end().len() {
        assert!(!answer(&CRANE.as_bytes()[..length], length as u64));
    }
}

#[test]
fn random_bytes_and_random_markup_get_an_answer() {
    for seed in 1..=2000 {
        let mut random = Random(seed);
        let length = random.below(200);
        let bytes: Vec<u8> = (0..length).map(|_| random.next() as u8).collect();
        answer(&bytes, seed);
        let markup: Vec<u8> = (0..length / 4).flat_map(|_| PIECES[random.below(PIECES.len())]).copied().collect();
        answer(&markup, seed);
        answer(&[b"<robot name='r'>", markup.as_slice(), b"</robot>"].concat(), seed);
    }
}

#[test]
fn deep_wide_and_explosive_documents_are_refused() {
    let bomb: String = (1..10).fold("<!DOCTYPE r [<!ENTITY e0 'lol'>".to_owned(), |mut text, i| {
        let _ = write!(text, "<!ENTITY e{i} '{}'>", format!("&e{};", i - 1).repeat(10));
        text
    });
    let attributes: String = (0..100_000).fold(String::new(), |mut text, i| {
        let _ = write!(text, " a{i}='1'");
        text
    });
    let cases = [
        (format!("{bomb}]><robot name='&e9;'/>"), Code::Doctype),
        (format!("<robot name='r'>{}", "<link>".repeat(1_000_000)), Code::TooLarge),
        (format!("<robot name='r'{attributes}/>"), Code::TooLarge),
        ("=".repeat(10_000_000), Code::TooLarge),
        (" ".repeat(65 << 20), Code::TooLarge),
        (format!("<robot name='r'><link name='{}'>{}</link></robot>", "x".repeat(1 << 20), "<a/>".repeat(10_000)), Code::TooLarge),
    ];
    for (text, kind) in cases {
        let problems = read(text.as_bytes(), &Options::default()).unwrap_err();
        assert_eq!(problems.errors[0].code, kind, "{problems}");
    }
}

/// A chain of links, each below the one before; `close`: where the last hangs the first.
fn chain(links: usize, close: bool, kind: &str) -> String {
    let mut text = String::from("<robot name='chain'>");
    (0..links).for_each(|i| write!(text, "<link name='{i}'/>").unwrap());
    for i in 0..links - usize::from(!close) {
        let child = (i + 1) % links;
        write!(text, "<joint name='{i}' type='{kind}'><parent link='{i}'/><child link='{child}'/></joint>").unwrap();
    }
    text + "</robot>"
}

#[test]
fn a_long_chain_is_read() {
    let reading = read(chain(5_000, false, "fixed").as_bytes(), &Options::default()).unwrap();
    assert_eq!(reading.description.joints.len(), 4_999);
    assert_eq!(reading.description.joints[JointId(4_998)].child, LinkId(4_999));
}

/// An error at the end skips the second reader; all of this crate's code runs.
#[test]
fn a_chain_of_100_000_links_is_walked_without_recursion() {
    let text = chain(100_000, false, "continuous").replace("</robot>", "<link name='99999'/></robot>");
    let problems = read(text.as_bytes(), &Options::default()).unwrap_err();
    assert_eq!(problems.errors.len(), 1, "{problems}");
    assert_eq!(problems.errors[0].code, Code::DuplicateName);
}

#[test]
fn a_ring_of_100_000_links_is_one_error() {
    let problems = read(chain(100_000, true, "fixed").as_bytes(), &Options::default()).unwrap_err();
    assert_eq!(problems.errors.len(), 1);
    assert_eq!(problems.errors[0].code, Code::Ring);
    assert!(problems.to_string().len() < 1000);
}

#[test]
fn mimics_of_mimics_are_followed_without_recursion() {
    let text = chain(20_000, false, "continuous");
    let mut out = String::new();
    for (i, piece) in text.split("</joint>").enumerate() {
        let end = if i < 19_999 { format!("<mimic joint='{}'/></joint>", (i + 1) % 19_999) } else { String::new() };
        out.extend([piece, &end]);
    }
    let problems = read(out.as_bytes(), &Options::default()).unwrap_err();
    assert_eq!(problems.errors.len(), 1, "{problems}");
    assert_eq!(problems.errors[0].code, Code::MimicRing);
}

#[test]
fn what_is_not_used_is_counted_where_there_is_very_much() {
    let text = format!("<robot name='r'><link name='l'/>{}</robot>", "<a/>".repeat(100_010));
    let reading = read(text.as_bytes(), &Options::default()).unwrap();
    assert_eq!(reading.unused.len(), 100_001);
    assert_eq!(reading.unused[100_000].tag, "10 more");
}

#[test]
fn very_many_unknown_names_are_reported_soon() {
    let mut text = chain(20_000, false, "fixed");
    text = text.replace("<parent link='", "<parent link='unknown_link_");
    let problems = read(text.as_bytes(), &Options::default()).unwrap_err();
    assert!(problems.errors.len() > 1000);
}
