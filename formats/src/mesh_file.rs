//! Files of meshes: STL, OBJ and MuJoCo's MSH.
//!
//! A library for meshes would have to keep the order of faces and the single precision of MuJoCo,
//! and no library reads MSH.

use std::path::Path;

use articulated_core::diagnostic::quote;

use crate::pose::{Vector, norm, subtract};

/// Vertices that are read have coordinates of single precision, as in MuJoCo.
#[derive(Debug, Default)]
pub(crate) struct Triangles {
    pub(crate) vertices: Vec<Vector>,
    pub(crate) faces: Vec<[u32; 3]>,
    /// Whether the file has more faces, of other objects.
    pub(crate) has_others: bool,
}

/// The triangles of a file, by its type or by the ending of its name. Errors: what was found.
pub(crate) fn parse(bytes: &[u8], path: &Path, content_type: &str) -> Result<Triangles, String> {
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default();
    let triangles = match (content_type, ending.as_str()) {
        ("model/stl", _) | ("", "stl") => stl(bytes),
        ("model/obj", _) | ("", "obj") => obj(bytes),
        ("model/vnd.mujoco.msh", _) | ("", "msh") => msh(bytes),
        _ => return Err(format!("the ending {}", quote(&ending))),
    };
    let triangles = triangles.ok_or("a file that is cut off or not of this format")?;
    let finite = triangles.vertices.iter().flatten().all(|x| x.is_finite());
    if finite { Ok(triangles) } else { Err("coordinates that are not finite".to_owned()) }
}

fn floats(bytes: &[u8]) -> impl Iterator<Item = f32> {
    bytes.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]))
}

/// 80 bytes, the number of faces, and for each face a normal, three vertices and two bytes.
fn stl(bytes: &[u8]) -> Option<Triangles> {
    let count = u32::from_le_bytes(bytes.get(80..84)?.try_into().ok()?) as usize;
    let faces = bytes.get(84..84 + count.checked_mul(50)?)?;
    let mut triangles = Triangles::default();
    for face in faces.chunks_exact(50) {
        let numbers: Vec<f64> = floats(&face[12..48]).map(f64::from).collect();
        let first = triangles.vertices.len() as u32;
        triangles.vertices.extend(numbers.chunks_exact(3).map(|v| [v[0], v[1], v[2]]));
        triangles.faces.push([first, first + 1, first + 2]);
    }
    Some(triangles)
}

/// The vertices of an STL in words: `vertex x y z`, three of them a face.
pub(crate) fn ascii_stl(bytes: &[u8], path: &Path) -> Option<Triangles> {
    let is_stl = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("stl"));
    let text = std::str::from_utf8(bytes).ok().filter(|text| is_stl && text.trim_start().starts_with("solid"))?;
    let mut triangles = Triangles::default();
    for line in text.lines() {
        let mut words = line.split_ascii_whitespace();
        if words.next() == Some("vertex") {
            let mut next = || words.next()?.parse::<f32>().ok().filter(|x| x.is_finite()).map(f64::from);
            triangles.vertices.push([next()?, next()?, next()?]);
        }
    }
    let count = triangles.vertices.len() as u32;
    triangles.faces = (0..count / 3).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    Some(triangles)
}

/// Four counts (vertices, normals, texture coordinates, faces), and then these.
fn msh(bytes: &[u8]) -> Option<Triangles> {
    let count = |k: usize| Some(i32::from_le_bytes(bytes.get(4 * k..4 * k + 4)?.try_into().ok()?));
    let count = |k: usize| count(k).and_then(|n| usize::try_from(n).ok());
    let [vertices, normals, texture, faces] = [count(0)?, count(1)?, count(2)?, count(3)?];
    let part = |from: usize, size: usize| bytes.get(from..from.checked_add(size)?);
    let at = 16 + vertices.checked_mul(12)? + normals.checked_mul(12)? + texture.checked_mul(8)?;
    let numbers: Vec<f64> = floats(part(16, vertices.checked_mul(12)?)?).map(f64::from).collect();
    let indices: Vec<u32> =
        part(at, faces.checked_mul(12)?)?.chunks_exact(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect();
    Some(Triangles {
        vertices: numbers.chunks_exact(3).map(|v| [v[0], v[1], v[2]]).collect(),
        faces: indices.chunks_exact(3).map(|f| [f[0], f[1], f[2]]).collect(),
        has_others: false,
    })
}

/// The lines `v` and `f`; of several objects (`o`) or groups (`g`) the faces of the first that has
/// any, as MuJoCo reads them.
pub(crate) fn obj(bytes: &[u8]) -> Option<Triangles> {
    let text = String::from_utf8_lossy(bytes);
    let mut triangles = Triangles::default();
    let (mut polygon, mut is_over) = (Vec::new(), false);
    for line in text.lines() {
        let mut words = line.split_ascii_whitespace();
        let has_more = line.trim_start().len() > 1;
        match words.next() {
            Some("o" | "g") if has_more => is_over = !triangles.faces.is_empty(),
            Some("f") if is_over => triangles.has_others = true,
            Some("v") => {
                let mut next = || words.next()?.parse::<f32>().ok().map(f64::from);
                triangles.vertices.push([next()?, next()?, next()?]);
            }
            Some("f") => {
                polygon.clear();
                for word in words {
                    let index: i64 = word.split('/').next()?.parse().ok()?;
                    let index = if index < 0 { triangles.vertices.len() as i64 + index } else { index - 1 };
                    polygon.push(u32::try_from(index).ok()?);
                }
                split(&polygon, &mut triangles)?;
            }
            _ => {}
        }
    }
    Some(triangles)
}

/// Splits a polygon into triangles: one of four corners along its shorter diagonal, others from
/// their first corner.
fn split(polygon: &[u32], into: &mut Triangles) -> Option<()> {
    if let [a, b, c, d] = *polygon {
        let vertex = |k: u32| into.vertices.get(k as usize).copied();
        let length = |from: u32, to: u32| Some(norm(subtract(vertex(from)?, vertex(to)?)));
        let faces = if length(a, c)? < length(b, d)? { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
        into.faces.extend(faces);
        return Some(());
    }
    into.faces.extend((1..polygon.len().max(2) - 1).map(|k| [polygon[0], polygon[k], polygon[k + 1]]));
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_that_are_cut_off_are_refused() {
        let mut bytes = vec![0; 84];
        bytes[80] = 2;
        assert!(stl(&bytes).is_none());
        bytes.extend([0; 100]);
        assert_eq!(stl(&bytes).unwrap().faces.len(), 2);
        bytes[80..84].fill(0xff);
        assert!(stl(&bytes).is_none());
        assert!(msh(&[0xff; 64]).is_none() && msh(&[0; 3]).is_none());
        assert!(obj(b"v 0 0\n").is_none() && obj(b"f 1 2 x\n").is_none() && obj(b"f 1 2 3 9\n").is_none());
    }
}
