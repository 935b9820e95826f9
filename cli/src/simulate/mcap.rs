//! A motion as an MCAP file: joint states and transforms in JSON, for Foxglove, Rerun and the like.
//!
//! The container is written here: the command needs three sorts of records of it, uncompressed
//! (<https://mcap.dev/spec>). Tests read it with the crate `mcap`.

use std::collections::BTreeMap;

use articulated_core::algorithm::FunctionError;
use articulated_core::description::{Base, Description};
use articulated_core::dynamics::Dynamics;
use articulated_core::model::Model;
use articulated_core::spatial::Placement;
use nalgebra::{Rotation3, UnitQuaternion};
use serde::Serialize;
use serde_json::{Value, json};

use super::page::placement;
use super::recording::Recording;

/// The first and the last bytes of a file.
const MAGIC: &[u8] = b"\x89MCAP0\r\n";
/// Bytes after which a chunk ends.
const CHUNK: usize = 1 << 20;

/// Topics with the names that viewers know their schemas by.
const TRANSFORMS: (&str, &str) = ("/tf", "foxglove.FrameTransforms");
const JOINTS: (&str, &str) = ("/joint_states", "sensor_msgs/msg/JointState");

#[derive(Clone, Copy, Serialize)]
struct Time {
    sec: u64,
    nsec: u64,
}

#[derive(Serialize)]
struct Vector {
    x: f64,
    y: f64,
    z: f64,
}

#[derive(Serialize)]
struct Quaternion {
    x: f64,
    y: f64,
    z: f64,
    w: f64,
}

#[derive(Serialize)]
struct Transforms<'a> {
    transforms: Vec<Transform<'a>>,
}

#[derive(Serialize)]
struct Transform<'a> {
    timestamp: Time,
    parent_frame_id: &'a str,
    child_frame_id: &'a str,
    translation: Vector,
    rotation: Quaternion,
}

#[derive(Serialize)]
struct JointState<'a> {
    header: Header<'a>,
    name: &'a [&'a str],
    position: Vec<f64>,
    velocity: Vec<f64>,
    effort: Vec<f64>,
}

#[derive(Serialize)]
struct Header<'a> {
    stamp: Time,
    frame_id: &'a str,
}

/// The file's bytes; `None` if there are more than `most`. `model` has a frame for each link.
pub(super) fn bytes(
    r: &Recording,
    description: &Description,
    model: &Model<f64>,
    base: Base,
    most: usize,
) -> Result<Option<Vec<u8>>, FunctionError> {
    let links: Vec<&str> = model.frames().iter().map(|f| f.name.as_str()).filter(|name| description.link(name).is_some()).collect();
    let root = root(description, base);
    let children: Vec<&str> = links.into_iter().filter(|name| *name != root).collect();
    let Ok(framed) = model.clone().with_frames(&children) else { return Ok(Some(Vec::new())) };
    let (mut ws, mut row) = (Dynamics::workspace(&framed), vec![0.0; 12 * children.len()]);
    // The positions of a joint with several coordinates are among the transforms.
    let joints: Vec<(&str, usize, usize)> =
        model.joints().iter().filter(|j| j.q.1 == 1 && j.v.1 == 1).map(|j| (j.name.as_str(), j.q.0, j.v.0)).collect();
    let names: Vec<&str> = joints.iter().map(|j| j.0).collect();
    let (nq, nv) = (r.q_names.len(), r.v_names.len());
    // Times are not negative.
    let zero = r.t.first().copied().unwrap_or(0.0).min(0.0);
    let mut file = Writer::new(&[(TRANSFORMS, transforms_schema()), (JOINTS, joints_schema())]);
    for (k, t) in r.t.iter().enumerate() {
        let nanoseconds = ((t - zero) * 1e9).round() as u64;
        let stamp = Time { sec: nanoseconds / 1_000_000_000, nsec: nanoseconds % 1_000_000_000 };
        let (q, v, tau) = (&r.q[k * nq..][..nq], &r.v[k * nv..][..nv], &r.tau[k * nv..][..nv]);
        framed.placements(&mut ws, q, &mut row)?;
        let places = row.chunks_exact(12).map(placement);
        let transforms = children.iter().zip(places).map(|(link, place)| transform(stamp, &root, link, &place)).collect();
        file.message(0, k, nanoseconds, &Transforms { transforms });
        file.message(
            1,
            k,
            nanoseconds,
            &JointState {
                header: Header { stamp, frame_id: &root },
                name: &names,
                position: joints.iter().map(|j| q[j.1]).collect(),
                velocity: joints.iter().map(|j| v[j.2]).collect(),
                effort: joints.iter().map(|j| tau[j.2]).collect(),
            },
        );
        if file.len() > most {
            return Ok(None);
        }
    }
    Ok(Some(file.finish()))
}

/// The frame of placements: the root link of a fixed base, else the world, with a name that no link
/// has.
fn root(description: &Description, base: Base) -> String {
    match (base, description.root()) {
        (Base::Fixed, Some(root)) => description.links[root].name.clone(),
        _ => ["world", "map", "odom"].into_iter().find(|name| description.link(name).is_none()).unwrap_or("world_frame").to_owned(),
    }
}

fn transform<'a>(timestamp: Time, parent: &'a str, child: &'a str, place: &Placement<f64>) -> Transform<'a> {
    let [x, y, z] = place.position.into();
    let q = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(place.rotation));
    let rotation = Quaternion { x: q.i, y: q.j, z: q.k, w: q.w };
    Transform { timestamp, parent_frame_id: parent, child_frame_id: child, translation: Vector { x, y, z }, rotation }
}

fn object(title: &str, properties: &Value) -> Value {
    json!({ "title": title, "type": "object", "properties": properties })
}

fn numbers(names: &[&str]) -> Value {
    let properties = names.iter().map(|name| ((*name).to_owned(), json!({ "type": "number" }))).collect();
    json!({ "type": "object", "properties": Value::Object(properties) })
}

fn time() -> Value {
    let part = || json!({ "type": "integer", "minimum": 0 });
    json!({ "type": "object", "title": "time", "properties": { "sec": part(), "nsec": part() } })
}

fn transforms_schema() -> Value {
    let transform = object(
        "foxglove.FrameTransform",
        &json!({
            "timestamp": time(),
            "parent_frame_id": { "type": "string" },
            "child_frame_id": { "type": "string" },
            "translation": numbers(&["x", "y", "z"]),
            "rotation": numbers(&["x", "y", "z", "w"]),
        }),
    );
    object(TRANSFORMS.1, &json!({ "transforms": { "type": "array", "items": transform } }))
}

fn joints_schema() -> Value {
    let list = |of: &str| json!({ "type": "array", "items": { "type": of } });
    object(
        JOINTS.1,
        &json!({
            "header": object("std_msgs/msg/Header", &json!({ "stamp": time(), "frame_id": { "type": "string" } })),
            "name": list("string"),
            "position": list("number"),
            "velocity": list("number"),
            "effort": list("number"),
        }),
    )
}

/// Kinds of records, by the specification.
#[derive(Clone, Copy)]
#[repr(u8)]
enum Op {
    Header = 0x01,
    Footer = 0x02,
    Schema = 0x03,
    Channel = 0x04,
    Message = 0x05,
    Chunk = 0x06,
    MessageIndex = 0x07,
    ChunkIndex = 0x08,
    Statistics = 0x0B,
    DataEnd = 0x0F,
}

/// Times and offsets of messages, by their channels.
type Index = BTreeMap<u16, Vec<(u64, u64)>>;

/// Writes messages in the order of their times.
struct Writer {
    out: Vec<u8>,
    /// Schemas and channels.
    declared: Vec<u8>,
    chunk: Vec<u8>,
    index: Index,
    chunk_indexes: Vec<u8>,
    chunks: u32,
    channels: u16,
    counts: BTreeMap<u16, u64>,
    /// ns; of the chunk, and of all.
    times: Option<[u64; 2]>,
    all_times: Option<[u64; 2]>,
}

impl Writer {
    /// With a channel for each topic and schema, numbered from 0.
    fn new(topics: &[((&str, &str), Value)]) -> Self {
        let mut declared = Vec::new();
        for (id, ((topic, name), schema)) in (0_u16..).zip(topics) {
            // Schemas count from 1.
            let content = [&(id + 1).to_le_bytes()[..], &text(name), &text("jsonschema"), &text(&schema.to_string())].concat();
            record(&mut declared, Op::Schema, &content);
            let ids = [id.to_le_bytes(), (id + 1).to_le_bytes()].concat();
            record(&mut declared, Op::Channel, &[&ids, &text(topic)[..], &text("json"), &0_u32.to_le_bytes()].concat());
        }
        let mut out = MAGIC.to_vec();
        record(&mut out, Op::Header, &[text(""), text(concat!("articulated ", env!("CARGO_PKG_VERSION")))].concat());
        out.extend_from_slice(&declared);
        Self {
            out,
            declared,
            chunk: Vec::new(),
            index: Index::new(),
            chunk_indexes: Vec::new(),
            chunks: 0,
            channels: topics.len() as u16,
            counts: BTreeMap::new(),
            times: None,
            all_times: None,
        }
    }

    /// Bytes so far.
    fn len(&self) -> usize {
        self.out.len() + self.chunk.len()
    }

    fn message(&mut self, channel: u16, sequence: usize, time: u64, content: &impl Serialize) {
        let data = serde_json::to_vec(content).unwrap_or_default();
        let time_bytes = time.to_le_bytes();
        let head = [&channel.to_le_bytes()[..], &(sequence as u32).to_le_bytes(), &time_bytes, &time_bytes].concat();
        self.index.entry(channel).or_default().push((time, self.chunk.len() as u64));
        *self.counts.entry(channel).or_default() += 1;
        record(&mut self.chunk, Op::Message, &[head, data].concat());
        for times in [&mut self.times, &mut self.all_times] {
            *times = Some(times.map_or([time; 2], |[first, last]| [first.min(time), last.max(time)]));
        }
        if self.chunk.len() >= CHUNK {
            self.end_chunk();
        }
    }

    fn end_chunk(&mut self) {
        let Some([first, last]) = self.times.take() else { return };
        let (records, index) = (std::mem::take(&mut self.chunk), std::mem::take(&mut self.index));
        let (start, size) = (self.out.len() as u64, words(&[records.len() as u64]));
        let times = words(&[first, last]);
        // No checksum, no compression.
        let head = [&times[..], &size, &0_u32.to_le_bytes(), &text("")].concat();
        record(&mut self.out, Op::Chunk, &[head, size.clone(), records].concat());
        let length = self.out.len() as u64 - start;
        let (mut offsets, indexes) = (Vec::new(), self.out.len());
        for (channel, messages) in &index {
            offsets.extend([channel.to_le_bytes().to_vec(), words(&[self.out.len() as u64])].concat());
            let entries: Vec<u8> = messages.iter().flat_map(|(time, offset)| words(&[*time, *offset])).collect();
            record(&mut self.out, Op::MessageIndex, &[channel.to_le_bytes().to_vec(), sized(&entries)].concat());
        }
        let after = words(&[(self.out.len() - indexes) as u64]);
        let content = [times, words(&[start, length]), sized(&offsets), after, text(""), size.clone(), size].concat();
        record(&mut self.chunk_indexes, Op::ChunkIndex, &content);
        self.chunks += 1;
    }

    fn finish(mut self) -> Vec<u8> {
        self.end_chunk();
        record(&mut self.out, Op::DataEnd, &0_u32.to_le_bytes());
        let summary = self.out.len() as u64;
        self.out.extend_from_slice(&self.declared);
        self.out.extend_from_slice(&self.chunk_indexes);
        let counts: Vec<u8> =
            self.counts.iter().flat_map(|(channel, count)| [channel.to_le_bytes().to_vec(), words(&[*count])].concat()).collect();
        // Schemas, channels, attachments, metadata, chunks.
        let of_kinds = [u32::from(self.channels), 0, 0, self.chunks].map(u32::to_le_bytes).concat();
        let all = words(&[self.counts.values().sum()]);
        let times = words(&self.all_times.unwrap_or_default());
        let statistics = [all, self.channels.to_le_bytes().to_vec(), of_kinds, times, sized(&counts)].concat();
        record(&mut self.out, Op::Statistics, &statistics);
        record(&mut self.out, Op::Footer, &[words(&[summary, 0]), vec![0; 4]].concat());
        self.out.extend_from_slice(MAGIC);
        self.out
    }
}

fn record(out: &mut Vec<u8>, op: Op, content: &[u8]) {
    out.push(op as u8);
    out.extend((content.len() as u64).to_le_bytes());
    out.extend_from_slice(content);
}

fn words(all: &[u64]) -> Vec<u8> {
    all.iter().flat_map(|word| word.to_le_bytes()).collect()
}

/// Bytes after their number.
fn sized(bytes: &[u8]) -> Vec<u8> {
    [&(bytes.len() as u32).to_le_bytes(), bytes].concat()
}

fn text(text: &str) -> Vec<u8> {
    sized(text.as_bytes())
}
