//! A step of a simulation allocates nothing.
#![allow(unsafe_code)]
// Why: only the allocator can count allocations.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicU64, Ordering};

use articulated::simulate::{Control, Event, Hold, IntegratorId, Output, Pd, Settings, Simulation, integrators};
use articulated::{Base, Model, load_bytes};

struct Counted;

static COUNT: AtomicU64 = AtomicU64::new(0);

// SAFETY: every call is passed on to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counted {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        COUNT.fetch_add(1, Ordering::Relaxed);
        // SAFETY: the caller's promise is passed on.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        // SAFETY: the caller's promise is passed on.
        unsafe { System.dealloc(at, layout) }
    }

    unsafe fn realloc(&self, at: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        COUNT.fetch_add(1, Ordering::Relaxed);
        // SAFETY: the caller's promise is passed on.
        unsafe { System.realloc(at, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counted = Counted;

fn robot() -> Model<f64> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/simulate/urdf/satellite.urdf");
    load_bytes("satellite", &std::fs::read(path).unwrap(), Base::Floating).unwrap()
}

/// Allocations, steps and events of a motion that long, in room that was made before, its
/// controller sampled or not.
fn motion(robot: &Model<f64>, integrator: IntegratorId, end: f64, sampled: bool) -> (u64, u64, usize) {
    let step = (!integrator.row().adaptive).then_some(2e-3);
    let settings = Settings { integrator, end, step, rtol: 1e-7, output: Output::Every(0.02), ..Settings::default() };
    let mut simulation = Simulation::new(robot, settings).unwrap().with_energy_balance();
    let q = [0.3, -0.2, 0.5, 0.5, -0.5, 0.5, 0.5, 0.7, 0.1, 0.7, -0.1, 0.7];
    let v = [1.8, -1.5, 2.0, 0.3, -0.2, 0.5, 0.4, 0.1, -0.1, 0.1];
    let pd = Pd::new(robot, q.to_vec(), vec![0.1; 10], vec![0.1; 10]).unwrap();
    let mut control: Box<dyn Control> = if sampled { Box::new(Hold::new(pd, 0.01).unwrap()) } else { Box::new(pd) };
    // Coordinate 7 starts at 0.7 with a rate of 0.4.
    let mut events = [Event::limit("far", 7, -10.0, 10.0), Event::limit("passed", 7, -10.0, 0.72)];
    let mut recording = simulation.recording();
    // Once, so that whatever grows has grown.
    simulation.run_into(&q, &v, &mut *control, &mut events, &mut recording, &mut |_, _| true).unwrap();
    let before = COUNT.load(Ordering::Relaxed);
    simulation.run_into(&q, &v, &mut *control, &mut events, &mut recording, &mut |_, _| true).unwrap();
    (COUNT.load(Ordering::Relaxed) - before, recording.counts.steps, recording.events.len())
}

#[test]
fn no_step_allocates() {
    let robot = robot();
    for (row, sampled) in integrators().iter().flat_map(|row| [(row, false), (row, true)]) {
        let (count, steps, events) = motion(&robot, row.id, 0.2, sampled);
        println!("{}: {count} allocations in {steps} steps", row.name);
        assert!(steps > 3 && count == 0, "{}, sampled {sampled}: {count} allocations in {steps} steps", row.name);
        assert!(events > 0, "{}, sampled {sampled}: nothing happened", row.name);
    }
}
