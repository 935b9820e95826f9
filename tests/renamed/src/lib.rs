//! The macro in a crate that knows `articulated` under another name only.
//!
//! A library, because the compiler requires documentation only there; generated code satisfies the
//! strictest user.
#![deny(missing_docs, unreachable_pub, dead_code, unused, nonstandard_style, unsafe_code, clippy::all, clippy::pedantic, clippy::nursery)]

dynamics::robot! {
    /// Two links on hinges.
    pub mod arm {
        urdf = "../ui/urdf/arm.urdf",
        crate = ::dynamics,
    }
}

#[cfg(test)]
mod tests {
    use super::arm;
    use dynamics::Dynamics;

    #[test]
    fn a_renamed_dependency_is_named_in_the_macro() {
        assert_eq!(arm::Robot.shape(), dynamics::Shape { nq: 2, nv: 2, frames: 3, links: 2, ..dynamics::Shape::default() });
    }
}
