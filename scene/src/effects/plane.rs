//! Contact with the planes of the robot's file.

use articulated_core::diagnostic::{Code, Diagnostics, quote};
use articulated_core::effect::{Effect, EffectId};
use articulated_formats::world::{ContactMask, Plane};

use super::{EffectRequest, Numbers};
use crate::table::Cursor;
use crate::tree::Value;

/// The key `plane` of a contact.
pub(super) const KEY: &str = "plane";
/// Its only value.
const FILE: &str = "file";
/// The fields that a plane supplies.
const OWN: [&str; 2] = ["normal", "height"];
/// Maximum number of a file's planes for contact: each link meets each plane.
const MOST: usize = 100;

/// Whether the effect acts against a plane.
pub(super) fn offers(row: &Effect) -> bool {
    row.id == EffectId::contact
}

/// Whether the value of the key is the word for the planes of the file.
pub(super) fn is_of_file(spot: &Cursor<'_>, log: &mut Diagnostics) -> bool {
    match &spot.node.value {
        Value::Text(word) if word == FILE => return true,
        Value::Text(word) => log.error((spot.node.at, &spot.key), Code::Word, quote(word), format!("\"{FILE}\"")),
        _ => spot.wrong(log, format!("\"{FILE}\"")),
    }
    false
}

/// Reports `normal` or `height` combined with `plane = "file"`.
pub(super) fn refuse_own_plane(spot: &Cursor<'_>, log: &mut Diagnostics) {
    for own in OWN.into_iter().filter_map(|key| spot.get(key)) {
        let name = own.key.rsplit('.').next().unwrap_or_default();
        own.clash(log, format!("{name} beside plane = \"{FILE}\""), "one of both: the robot's file gives the planes");
    }
}

/// The numbers of a request against a plane, and the mask of geometry in contact with it.
pub(super) type Against = (Numbers, Option<ContactMask>);

/// The numbers of a request for each plane; a single one if it has its own plane. `None` is an
/// error: it uses the file's planes, and there are none or too many.
pub(super) fn of(
    row: &Effect,
    one: &EffectRequest,
    says: &Numbers,
    rest: Option<&Numbers>,
    planes: &[Plane],
    log: &mut Diagnostics,
) -> Option<Vec<Against>> {
    let places = OWN.map(|name| row.fields.iter().position(|field| field.name == name));
    let has_own = places.iter().flatten().any(|place| says.fields[*place].is_some());
    if !says.from_file_planes && (has_own || !rest.is_some_and(|rest| rest.from_file_planes)) {
        return Some(vec![(says.clone(), None)]);
    }
    if planes.is_empty() || planes.len() > MOST {
        let (found, expected) = match planes.len() {
            0 => ("\"file\", and the robot's file has no plane that makes contact".to_owned(), "`normal` and `height`".to_owned()),
            count => (format!("\"file\", and the robot's file has {count} planes"), format!("at most {MOST}, or `normal` and `height`")),
        };
        // Once, whatever the number of links.
        let is_reported = log.errors.iter().any(|error| error.code == Code::Robot && error.found == found);
        if !is_reported {
            log.error((one.place, &format!("{}.{KEY}", one.key)), Code::Robot, found, expected);
        }
        return None;
    }
    let against = |plane: &Plane| {
        let height = plane.normal.iter().zip(plane.point).map(|(normal, x)| normal * x).sum();
        let mut own = says.clone();
        for (place, numbers) in places.into_iter().zip([plane.normal.to_vec(), vec![height]]) {
            place.into_iter().for_each(|place| own.fields[place] = Some(numbers.clone()));
        }
        (own, plane.mask)
    };
    Some(planes.iter().map(against).collect())
}
