//! The texts that generated code copies. What they compute is tested where they are compiled.

use crate::lanes::{Real, Set, source, tiles};

const SETS: [(Set, Real, &[usize]); 10] = [
    (Set::Portable, Real::F64, &[2, 4, 8]),
    (Set::Portable, Real::F32, &[8, 16]),
    (Set::Sse2, Real::F64, &[2, 4]),
    (Set::Sse2, Real::F32, &[4]),
    (Set::Avx2, Real::F64, &[2, 4]),
    (Set::Avx2, Real::F32, &[8]),
    (Set::Avx512, Real::F64, &[8]),
    (Set::Avx512, Real::F32, &[16]),
    (Set::Neon, Real::F64, &[2, 4]),
    (Set::Neon, Real::F32, &[4]),
];

#[test]
fn sources_are_for_the_features_of_their_set() {
    for (set, real, widths) in SETS {
        for lanes in 1..=32 {
            let text = source(set, real, lanes);
            assert_eq!(text.is_some(), widths.contains(&lanes), "{set:?} {real:?} {lanes}");
            let Some(text) = text.map(|text| text + &tiles(set, real, lanes).unwrap_or_default()) else { continue };
            let enabled: Vec<&str> =
                text.split("#[target_feature(enable = \"").skip(1).filter_map(|rest| Some(rest.split_once("\")]")?.0)).collect();
            assert_eq!(enabled.len(), text.matches("target_feature(enable").count());
            assert!(enabled.iter().flat_map(|some| some.split(',')).all(|one| set.features().split(',').any(|of_set| one == of_set)));
            assert_eq!(enabled.contains(&set.features()), set != Set::Portable);
            assert!(set == Set::Portable || text.contains(&format!("::core::arch::{}::", set.arch())));
        }
    }
}

#[test]
fn portable_sources_have_no_unsafe() {
    for (set, real, widths) in SETS {
        for lanes in widths {
            let tiles = tiles(set, real, *lanes).unwrap_or_default();
            assert_eq!(source(set, real, *lanes).unwrap().contains("unsafe"), set != Set::Portable);
            assert_eq!(tiles.contains("unsafe"), set != Set::Portable && !tiles.is_empty());
        }
    }
}
