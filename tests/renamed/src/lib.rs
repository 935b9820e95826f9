//! The macro in a crate that knows `articulated` under another name only.

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
        assert_eq!(arm::Robot.shape(), dynamics::Shape { nq: 2, nv: 2, frames: 3 });
    }
}
