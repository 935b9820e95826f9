//! Many states over several threads: the same bits as in one, every state reported, no allocation
//! for it.
#![allow(unsafe_code)]
// Why: to count allocations, the allocator has to be wrapped.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use articulated::in_threads;

articulated::robot! {
    mod arm {
        urdf = "robots/arm.urdf",
        frames = [tool],
        functions = [inverse_dynamics, both = bias_forces + mass_matrix],
        batch = [f64, f32],
    }
}

use arm::{batch_f32, batch_f64};

/// The system's, counted.
struct Counted;

static ALLOCATIONS: AtomicUsize = AtomicUsize::new(0);

// SAFETY: every call is handed on to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counted {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        // SAFETY: the caller's promise is handed on.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller's promise is handed on.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counted = Counted;

/// Tests of this file also count allocations of the others: one at a time.
static ALONE: Mutex<()> = Mutex::new(());

/// Numbers that look random, in [−1, 1).
fn states<const N: usize>(n: usize, salt: usize) -> Vec<[f64; N]> {
    (0..n).map(|i| std::array::from_fn(|k| ((N * i + k + salt) as f64 * 0.754_877_666_246_692_7).fract() * 2.0 - 1.0)).collect()
}

fn pool(threads: usize) -> rayon::ThreadPool {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap()
}

fn bits(x: &[[f64; 3]]) -> Vec<u64> {
    x.as_flattened().iter().map(|x| x.to_bits()).collect()
}

#[test]
fn any_number_of_threads_gives_what_one_gives_to_the_bit() {
    let _alone = ALONE.lock();
    for n in [0, 1, 15, 16, 17, 255, 1000, 4099] {
        let [q, v, a] = [1, 101, 211].map(|salt| states::<3>(n, salt));
        let (mut alone, mut bias, mut mass) = (vec![[0.0; 3]; n], vec![[0.0; 3]; n], vec![[[0.0; 3]; 3]; n]);
        batch_f64::inverse_dynamics(&q, &v, &a, &mut alone).unwrap();
        batch_f64::both(&q, &v, &mut bias, &mut mass).unwrap();
        for threads in [1, 2, 3, 7] {
            let (mut out, mut h, mut m) = (vec![[f64::NAN; 3]; n], vec![[f64::NAN; 3]; n], vec![[[f64::NAN; 3]; 3]; n]);
            pool(threads).install(|| {
                let all = (&q[..], &v[..], &a[..], &mut out[..]);
                in_threads(all, |(q, v, a, out)| batch_f64::inverse_dynamics(q, v, a, out), |_| ()).unwrap();
                let all = (&q[..], &v[..], (&mut h[..], &mut m[..]));
                in_threads(all, |(q, v, (h, m))| batch_f64::both(q, v, h, m), |_| ()).unwrap();
            });
            assert!(
                bits(&out) == bits(&alone) && bits(&h) == bits(&bias) && bits(m.as_flattened()) == bits(mass.as_flattened()),
                "{n} {threads}"
            );
        }
    }
}

#[test]
fn blocks_and_single_numbers_go_the_same_way() {
    let _alone = ALONE.lock();
    let block = |salt: usize, k: usize| batch_f32::Lanes(std::array::from_fn(|lane| ((salt + 3 * lane + k) as f32 * 0.618).fract()));
    let blocks = |salt: usize| (0..100).map(|i| std::array::from_fn(|k| block(salt + 48 * i, k))).collect::<Vec<[batch_f32::Lanes; 3]>>();
    let [q, v, a] = [1, 5003, 10_007].map(blocks);
    let (mut alone, mut out) = (vec![[batch_f32::Lanes::ZERO; 3]; 100], vec![[batch_f32::Lanes::ZERO; 3]; 100]);
    batch_f32::inverse_dynamics_blocks(&q, &v, &a, &mut alone).unwrap();
    let all = (&q[..], &v[..], &a[..], &mut out[..]);
    let parts = Mutex::new(0);
    let told = |_| *parts.lock().unwrap() += 1;
    pool(3).install(|| in_threads(all, |(q, v, a, out)| batch_f32::inverse_dynamics_blocks(q, v, a, out), told)).unwrap();
    assert!(out == alone && out[99][2].0[15] != 0.0);
    // Each block is full by itself: parts need not have sixteen.
    assert!(parts.into_inner().unwrap() >= 20);
}

#[test]
fn progress_counts_every_state_once() {
    let _alone = ALONE.lock();
    for n in [0, 1, 1000, 100_003] {
        let (x, mut y) = ((0..n).collect::<Vec<usize>>(), vec![0; n]);
        let told = Mutex::new(Vec::new());
        let copy = |(x, y): (&[usize], &mut [usize])| {
            y.copy_from_slice(x);
            Ok::<(), String>(())
        };
        pool(3).install(|| in_threads((&x[..], &mut y[..]), copy, |done| told.lock().unwrap().push(done))).unwrap();
        let mut told = told.into_inner().unwrap();
        told.sort_unstable();
        assert!(told.last() == Some(&n) && told.windows(2).all(|w| (1..=1024).contains(&(w[1] - w[0]))), "{told:?}");
        // Some parts for each thread if there are enough states.
        assert!(told.len() >= (n / 32).min(12) && x == y, "{} parts of {n}", told.len());
    }
}

#[test]
fn slices_of_different_lengths_are_refused_and_nothing_is_written() {
    let _alone = ALONE.lock();
    let (q, v) = (states::<3>(500, 1), states::<3>(499, 2));
    let mut out = vec![[7.0; 3]; 500];
    let all = (&q[..], &v[..], &q[..], &mut out[..]);
    let error = in_threads(all, |(q, v, a, out)| batch_f64::inverse_dynamics(q, v, a, out), |_| panic!("nothing is done")).unwrap_err();
    assert_eq!((error.argument, error.found, error.expected), ("v", 499, 500));
    assert_eq!(out, [[7.0; 3]; 500]);
}

#[test]
fn the_first_error_is_the_one_that_is_given() {
    let _alone = ALONE.lock();
    let x: Vec<usize> = (0..5000).collect();
    let refuse = |x: &[usize]| if x.iter().any(|x| x % 1000 == 999) { Err(x[0]) } else { Ok(()) };
    let first = pool(4).install(|| in_threads(&x[..], refuse, |_| ())).unwrap_err();
    assert!(first <= 999, "{first}");
}

#[test]
fn no_state_is_allocated_for() {
    let _alone = ALONE.lock();
    let pool = pool(3);
    let allocations = |n: usize| {
        let [q, v, a] = [1, 101, 211].map(|salt| states::<3>(n, salt));
        let mut out = vec![[f64::NAN; 3]; n];
        let before = ALLOCATIONS.load(Ordering::Relaxed);
        pool.install(|| {
            let all = (&q[..], &v[..], &a[..], &mut out[..]);
            in_threads(all, |(q, v, a, out)| batch_f64::inverse_dynamics(q, v, a, out), |_| ()).unwrap();
        });
        ALLOCATIONS.load(Ordering::Relaxed) - before
    };
    // The pool allocates little for its queues, and for a thread when it first finds work, and no
    // more for a hundred times as many parts: the minimum of some runs, as a thread may find no
    // work for a while.
    let found = [1000, 100_000].map(|n| (0..5).map(|_| allocations(n)).min());
    let found = found.map(Option::unwrap_or_default);
    assert!(found.iter().all(|n| *n <= 8), "{found:?}");
}
