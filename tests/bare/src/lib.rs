//! A crate without `std` that has robots in it. That it compiles is half of the test.

#![no_std]
#![forbid(unsafe_code)]

/// Six axes.
pub mod arm {
    include!(concat!(env!("OUT_DIR"), "/arm.rs"));
}

/// The same in `f32`.
pub mod arm_of_singles {
    include!(concat!(env!("OUT_DIR"), "/arm_of_singles.rs"));
}

/// The same in sums of two `f64` with correct sines.
pub mod arm_of_pairs {
    include!(concat!(env!("OUT_DIR"), "/arm_of_pairs.rs"));
}

/// Four legs on a floating base.
pub mod walker {
    include!(concat!(env!("OUT_DIR"), "/walker.rs"));
}
