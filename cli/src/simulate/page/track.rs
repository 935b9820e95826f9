//! Places of the bodies in each frame of the animation, in 14 bytes per body.

use articulated_core::spatial::Placement;
use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};

/// Frames a second, at most.
const RATE: f64 = 60.0;
/// Bodies times frames, at most: some 6 MB of the page.
const MOST: usize = 300_000;

/// Indices of the times that become frames: as many as are seen at this speed, including the first
/// and the last.
pub(super) fn chosen(t: &[f64], bodies: usize, speed: f64) -> Vec<usize> {
    let (Some(first), Some(last)) = (t.first(), t.last()) else { return Vec::new() };
    let frames = (MOST / bodies.max(1)).max(2) as f64;
    let gap = (speed.min(1.0) / RATE).max((last - first) / frames) * (1.0 - 1e-6);
    let mut chosen: Vec<usize> = Vec::new();
    for (k, &now) in t.iter().enumerate() {
        if chosen.last().is_none_or(|&before| now - t[before] >= gap) {
            chosen.push(k);
        }
    }
    if chosen.last() != Some(&(t.len() - 1)) {
        chosen.push(t.len() - 1);
    }
    chosen
}

/// Placements as numbers of 16 bits: position = low + quantum · n, quaternion (x, y, z, w) = n /
/// 32767.
#[derive(Clone, Debug)]
pub(super) struct Track {
    pub(super) low: [f64; 3],
    /// m.
    pub(super) quantum: [f64; 3],
    pub(super) bytes: Vec<u8>,
}

impl Track {
    /// Of all bodies of all frames, one after the other.
    pub(super) fn of(placements: &[Placement<f64>]) -> Self {
        let along = |k: usize| placements.iter().map(move |x| x.position[k]).filter(|x| x.is_finite());
        let low = [0, 1, 2].map(|k| along(k).fold(f64::INFINITY, f64::min)).map(|x| if x.is_finite() { x } else { 0.0 });
        let high = [0, 1, 2].map(|k| along(k).fold(low[k], f64::max));
        let quantum = [0, 1, 2].map(|k| ((high[k] - low[k]) / 65535.0).max(1e-9));
        let mut bytes = Vec::with_capacity(14 * placements.len());
        for x in placements {
            let position = (0..3).map(|k| ((x.position[k] - low[k]) / quantum[k]).round().clamp(0.0, 65535.0) as u16);
            bytes.extend(position.flat_map(u16::to_le_bytes));
            let q = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(x.rotation));
            bytes.extend(q.coords.iter().flat_map(|c| ((c * 32767.0).round() as i16).to_le_bytes()));
        }
        Self { low, quantum, bytes }
    }
}

/// A row of twelve numbers: a rotation row by row, then a position.
pub(crate) fn placement(row: &[f64]) -> Placement<f64> {
    Placement { rotation: Matrix3::from_row_slice(&row[..9]), position: Vector3::from_column_slice(&row[9..12]) }
}

/// Bytes as text.
pub(super) fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for part in bytes.chunks(3) {
        let word = part.iter().fold(0_u32, |w, b| w << 8 | u32::from(*b)) << (8 * (3 - part.len()));
        for k in 0..4 {
            out.push(if k > part.len() { '=' } else { char::from(DIGITS[(word >> (18 - 6 * k) & 63) as usize]) });
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_is_that_of_the_standard() {
        for (bytes, text) in [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")] {
            assert_eq!(base64(bytes.as_bytes()), text);
        }
    }

    #[test]
    fn frames_are_no_more_than_are_seen_and_end_at_the_end() {
        let t: Vec<f64> = (0..=1000).map(|k| f64::from(k) * 1e-3).collect();
        let frames = chosen(&t, 10, 1.0);
        assert!((59..=61).contains(&frames.len()), "{}", frames.len());
        assert_eq!((frames[0], frames[frames.len() - 1]), (0, 1000));
        let slow: Vec<f64> = (0..10).map(f64::from).collect();
        assert_eq!(chosen(&slow, 10, 1.0).len(), 10);
        assert!(chosen(&t, MOST / 10, 1.0).len() <= 12);
        assert!((110..=122).contains(&chosen(&t, 10, 0.5).len()) && chosen(&t, 10, 4.0) == frames);
        assert!(chosen(&[], 1, 1.0).is_empty());
    }

    #[test]
    fn a_placement_is_kept_to_a_65000th_of_the_way() {
        let turn = |a: f64| *Rotation3::from_euler_angles(a, 2.0 * a, -a).matrix();
        let placements: Vec<Placement<f64>> =
            (0..20).map(f64::from).map(|k| Placement { rotation: turn(k), position: Vector3::new(k, 0.5, -k * k) }).collect();
        let track = Track::of(&placements);
        let u = |at: usize| f64::from(u16::from_le_bytes([track.bytes[at], track.bytes[at + 1]]));
        let i = |at: usize| f64::from(i16::from_le_bytes([track.bytes[at], track.bytes[at + 1]])) / 32767.0;
        for (k, x) in placements.iter().enumerate() {
            for axis in 0..3 {
                let read = track.low[axis] + track.quantum[axis] * u(14 * k + 2 * axis);
                assert!((read - x.position[axis]).abs() <= 0.5 * track.quantum[axis] * (1.0 + 1e-9));
            }
            let q = [0, 1, 2, 3].map(|c| i(14 * k + 6 + 2 * c));
            let back = UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(q[3], q[0], q[1], q[2]));
            assert!((back.to_rotation_matrix().matrix() - x.rotation).amax() < 1e-4);
        }
    }
}
