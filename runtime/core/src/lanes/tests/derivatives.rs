//! Derivatives of inverse dynamics in loops over joints are what the run-time's give, on trees of revolute and prismatic joints, and cost what is said of them.

use core::array::from_fn;
use core::cell::RefCell;
use std::sync::LazyLock;

#[cfg(target_arch = "x86_64")]
use super::super::avx2_f64x4;
#[cfg(target_arch = "aarch64")]
use super::super::neon_f64x4;
use super::super::{DERIVATIVES_COST, portable_f64x4};
use crate::algorithm::{Workspace, inverse_dynamics_derivatives as generic};
use crate::effect::Effects;
use crate::joint::{Coordinates, Joint};
use crate::model::{Body, Model};
use crate::spatial::{Matrix3, Placement, Reference, SpatialInertia, Vector3, from_rpy};

/// Random numbers from −1 to 1; Knuth's constants, TAOCP 2, 3.3.4.
fn random(mut state: u64) -> impl FnMut() -> f64 {
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// Every body's mass.
const MASS: f64 = 1.5;

fn body(parent: usize, joint: Joint, at: (usize, usize), random: &mut impl FnMut() -> f64) -> Body<f64> {
    let mut three = || from_fn(|_| random());
    let placement = Placement { rotation: from_rpy(three()), position: three().into() };
    let own = Placement { rotation: from_rpy(three()), position: three().into() };
    Body {
        name: String::new(),
        parent,
        placement,
        joint,
        coordinates: Coordinates { q: at.0, v: at.1, mimic: None, pitch: 0.0 },
        inertia: SpatialInertia::from_central(MASS, Matrix3::from_diagonal(&Vector3::new(0.3, 0.2, 0.25)), &own),
        link: None,
        effects: Effects::none(),
    }
}

/// A body on a floating joint, and on it joints of which each stands on the body that it names; every third slides.
fn tree(parents: &[usize]) -> Model<f64> {
    let random = &mut random(parents.len() as u64);
    let mut bodies = vec![body(0, Joint::Revolute, (0, 0), random), body(0, Joint::Floating, (0, 0), random)];
    for (k, parent) in parents.iter().enumerate() {
        bodies.push(body(*parent, if k % 3 == 2 { Joint::Prismatic } else { Joint::Revolute }, (7 + k, 6 + k), random));
    }
    let n = parents.len();
    Model {
        name: String::new(),
        gravity: Vector3::new(0.4, -1.1, -9.7),
        wrench_reference: Reference::Body,
        bodies,
        frames: Vec::new(),
        joints: Vec::new(),
        nq: 7 + n,
        nv: 6 + n,
    }
}

/// xx, yy, zz, xy, xz, yz.
fn six(m: &Matrix3<f64>) -> [f64; 6] {
    [m[(0, 0)], m[(1, 1)], m[(2, 2)], m[(0, 1)], m[(0, 2)], m[(1, 2)]]
}

std::thread_local! {
    /// Additions, products, multiply-adds, signs and sines so far, of vectors.
    static COUNTED: RefCell<[u64; 5]> = const { RefCell::new([0; 5]) };
}

/// A set that counts.
mod counting {
    use super::portable_f64x4 as set;
    pub(super) use set::{V, array, lanes, load, turned_from};

    fn count(what: usize) {
        super::COUNTED.with_borrow_mut(|counted| counted[what] += 1);
    }

    macro_rules! counted {
        ($($name:ident($($x:ident),+): $what:literal;)+) => {
            $(pub(super) fn $name($($x: V),+) -> V { count($what); set::$name($($x),+) })+
        };
    }

    counted! {
        add(a, b): 0;
        sub(a, b): 0;
        mul(a, b): 1;
        fmadd(a, b, c): 2;
        fmsub(a, b, c): 2;
        fnmadd(a, b, c): 2;
        neg(a): 3;
    }

    pub(super) fn k(x: f64) -> V {
        set::k(x)
    }

    pub(super) fn across(x: V) -> V {
        set::across(x)
    }

    pub(super) fn sin_cos(x: V) -> (V, V) {
        count(4);
        set::sin_cos(x)
    }
}

/// The text with a tree of which each joint is a group of its own, in lane 0.
macro_rules! trees {
    ($($name:ident: $nv:literal, $paths:literal, $parents:expr;)+) => { $(
        #[allow(unsafe_code, dead_code, unused_imports, unused_macros, unused_unsafe, clippy::all, clippy::pedantic)]
        mod $name {
            use super::*;

            const NV: usize = $nv;
            const NQ: usize = NV + 1;
            const GROUPS: usize = NV - 6;
            const SLIDES: bool = true;
            const STEPS: usize = $paths;
            const MASS: f64 = super::MASS * (GROUPS + 1) as f64;

            static MODEL: LazyLock<Model<f64>> = LazyLock::new(|| tree(&$parents));
            static TREE: LazyLock<Vec<Group>> = LazyLock::new(|| (0..GROUPS).map(group).collect());
            static GRAVITY: LazyLock<Vector3<f64>> = LazyLock::new(|| MODEL.bodies[1].placement.rotation.transpose() * MODEL.gravity);
            static ROOT: LazyLock<Vec<f64>> = LazyLock::new(|| {
                let own = &MODEL.bodies[1].inertia;
                [own.mass].into_iter().chain(own.first.iter().copied()).chain(six(&own.second)).collect()
            });
            static CHUNKS: LazyLock<Vec<Chunk>> = LazyLock::new(|| {
                let which = |joints: &[usize]| joints.iter().map(|k| 1 << (k % 4)).sum();
                chunks().iter().map(|c| Chunk { at: c[0] / 4 * 4, which: which(c), column: 6 + c[0] / 4 * 4 }).collect()
            });
            static PATHS: LazyLock<[Path; STEPS]> = LazyLock::new(|| {
                let slots = paths().into_iter().map(|(_, to, before)| {
                    let first = chunks()[to][0];
                    Path { before: before as u16, first: 4 * first as u16, on: 4 * (MODEL.bodies[first + 2].parent - 2) as u16 }
                });
                slots.collect::<Vec<_>>().try_into().ok().expect("as many paths as were counted")
            });
            static BEFORE: LazyLock<Vec<Pair>> = LazyLock::new(|| pairs_of(|own, other| is_before(other, own)));
            static BEYOND: LazyLock<Vec<Pair>> = LazyLock::new(|| pairs_of(|own, other| own != other && is_before(own, other)));

            include!("../text/loops/derivatives_tables.rs");
            include!("../text/loops/derivatives_vectors.rs");
            include!("../text/loops/derivatives_sweeps.rs");
            include!("../text/loops/derivatives_pairs.rs");
            include!("../text/loops/derivatives_wide.rs");
            include!("../text/loops/derivatives.rs");

            fn first<const N: usize>(x: &[f64]) -> [Four; N] {
                from_fn(|i| [x[i], 0.0, 0.0, 0.0])
            }

            fn group(k: usize) -> Group {
                let body = &MODEL.bodies[k + 2];
                let parent = if body.parent == 1 { GROUPS.next_multiple_of(4) } else { body.parent - 2 };
                Group {
                    behind: if k % 2 == 0 { parent } else { APART },
                    parents: from_fn(|lane| (4 * parent + lane) as u16),
                    q: [7 + k as u16; 4],
                    v: [6 + k as u16; 4],
                    follows: first::<1>(&[f64::from(chunks().iter().all(|c| c[0] != k))])[0],
                    slides: first::<1>(&[f64::from(body.joint.moves_origin())])[0],
                    rotation: first(body.placement.rotation.transpose().as_slice()),
                    origin: first(body.placement.position.as_slice()),
                    mass: first::<1>(&[super::MASS])[0],
                    first: first(body.inertia.first.as_slice()),
                    second: first(&six(&body.inertia.second)),
                    beyond: first::<1>(&[super::MASS * (0..GROUPS).filter(|other| is_before(k, *other)).count() as f64])[0],
                }
            }

            fn is_before(k: usize, other: usize) -> bool {
                let parent = MODEL.bodies[other + 2].parent;
                k == other || parent > 1 && is_before(k, parent - 2)
            }

            /// Joints that follow one another within a block.
            fn chunks() -> Vec<Vec<usize>> {
                let mut chunks: Vec<Vec<usize>> = Vec::new();
                for k in 0..GROUPS {
                    match chunks.last_mut() {
                        Some(chunk) if k % 4 != 0 && MODEL.bodies[k + 2].parent == k + 1 => chunk.push(k),
                        _ => chunks.push(vec![k]),
                    }
                }
                chunks
            }

            fn chunk_of(k: usize) -> usize {
                chunks().iter().position(|chunk| chunk.contains(&k)).expect("each is in one")
            }

            /// From, to, and the path before; what stands on the root stands on no chunk.
            fn paths() -> Vec<(usize, usize, usize)> {
                let mut paths: Vec<(usize, usize, usize)> = Vec::new();
                for (to, chunk) in chunks().iter().enumerate() {
                    let Some(on) = MODEL.bodies[chunk[0] + 2].parent.checked_sub(2) else { continue };
                    let through = chunk_of(on);
                    let further: Vec<_> = (1..).zip(&paths).filter(|(_, p)| p.1 == through).map(|(k, p)| (p.0, to, k)).collect();
                    paths.push((through, to, 0));
                    paths.extend(further);
                }
                paths
            }

            /// Joints of a chunk in twos, each two with each chunk.
            fn pairs_of(meant: impl Fn(usize, usize) -> bool) -> Vec<Pair> {
                let mut pairs = Vec::new();
                for (from, of) in chunks().iter().enumerate() {
                    for (to, chunk) in chunks().iter().enumerate() {
                        let others = chunk[0] / 4 * 4;
                        let path = paths().iter().position(|p| (p.0, p.1) == (from.min(to), from.max(to))).map_or(0, |k| k + 1) as u16;
                        let asked = |own: usize| chunk.iter().filter(|k| meant(own, **k)).map(|k| 1 << (k % 4)).sum();
                        let row = |own: usize| Own { lane: own as u16 % 4, which: asked(own), place: ((6 + own) * NV + 6 + others) as u32 };
                        let met: Vec<usize> = of.iter().copied().filter(|own| asked(*own) != 0).collect();
                        for two in met.chunks(2) {
                            let second = two.get(1).map_or(Own { lane: 0, which: 0, place: 0 }, |own| row(*own));
                            pairs.push(Pair { at: of[0] as u16 / 4 * 4, path, others: others as u16, own: [row(two[0]), second] });
                        }
                    }
                }
                pairs
            }

            #[test]
            fn sweeps_read_no_number_before_it_is_written() {
                use super::portable_f64x4::*;
                derivatives!();
                narrow!();
                let mut random = random(NV as u64 + 1);
                let (q, v, a): ([f64; NQ], [f64; NV], [f64; NV]) = (from_fn(|_| random()), from_fn(|_| random()), from_fn(|_| random()));
                let found = [0.0, f64::NAN].map(|unknown| {
                    let mut out = [f64::NAN; 3 * MATRIX];
                    derivatives_in(&mut Bodies::new(Block::filled(Held::new([unknown; 4]))), &q, &v, &a, &mut out);
                    out.map(f64::to_bits)
                });
                assert_eq!(found[0], found[1]);
                assert!(found[1].iter().all(|x| f64::from_bits(*x).is_finite()));
            }

            #[test]
            fn lanes_lie_in_an_array_where_each_selected_one_does() {
                for numbers in 0..9 {
                    for place in 0..12 {
                        for which in 0..16 {
                            let expected = (0..4).all(|lane| which >> lane & 1 == 0 || place + lane < numbers);
                            assert_eq!(lies_in(numbers, place, which), expected, "{numbers} {place} {which:04b}");
                        }
                    }
                }
            }

            /// With AVX2 alone, where the processor has it: what this is compiled for may have more.
            fn in_fours(q: &[f64; NQ], v: &[f64; NV], a: &[f64; NV]) -> Option<[f64; 3 * MATRIX]> {
                #[cfg(target_arch = "x86_64")]
                if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
                    use super::avx2_f64x4::*;
                    derivatives!(#[target_feature(enable = "avx2,fma")]);
                    narrow!(#[target_feature(enable = "avx2,fma")]);
                    let mut out = [f64::NAN; 3 * MATRIX];
                    // SAFETY: the processor was just asked for both.
                    unsafe { derivatives(q, v, a, &mut out) };
                    return Some(out);
                }
                None
            }

            #[test]
            fn loops_over_joints_give_what_the_run_time_gives() {
                let mut random = random(NV as u64);
                let mut q: [f64; NQ] = from_fn(|_| random());
                let norm = q[3..7].iter().map(|x| x * x).sum::<f64>().sqrt();
                q[3..7].iter_mut().for_each(|x| *x /= norm);
                let (v, a): ([f64; NV], [f64; NV]) = (from_fn(|_| random()), from_fn(|_| random()));
                let mut expected = vec![0.0; 3 * NV * NV];
                generic(&MODEL, &mut Workspace::new(&MODEL), &q, &v, &a, &mut expected);
                let largest = expected.iter().fold(0.0_f64, |m, x| m.max(x.abs()));

                let mut found = [[[f64::NAN; NV]; NV]; 3];
                inverse_dynamics_derivatives(&q, &v, &a, &mut found);
                let mut portable = [f64::NAN; 3 * MATRIX];
                {
                    use super::counting::*;
                    derivatives!();
                    narrow!();
                    COUNTED.set([0; 5]);
                    derivatives(&q, &v, &a, &mut portable);
                }
                let in_fours = in_fours(&q, &v, &a).unwrap_or(portable);
                for found in [found.as_flattened().as_flattened(), &portable, &in_fours] {
                    for (found, expected) in found.iter().zip(&expected) {
                        assert!((found - expected).abs() < 64.0 * f64::EPSILON * largest, "{found} is not {expected}");
                    }
                }
                let joints = |pairs: &[Pair]| pairs.iter().flat_map(|pair| &pair.own).filter(|own| own.which != 0).count() as u64;
                let cost = DERIVATIVES_COST.of(GROUPS as u64, CHUNKS.len() as u64, joints(&BEFORE), joints(&BEYOND));
                // What no vector adds up.
                let apart = 27 * TREE.iter().filter(|group| group.behind == APART).count() as u64;
                let [additions, rest @ ..] = COUNTED.take();
                assert_eq!([additions + apart, rest[0], rest[1], rest[2], rest[3]], cost);
            }
        }
    )+ };
}

trees! {
    chain: 11, 1, [1, 2, 3, 4, 5];
    long: 16, 3, [1, 2, 3, 4, 5, 6, 7, 8, 9, 10];
    arms: 15, 2, [1, 2, 3, 1, 5, 6, 3, 8, 1];
    star: 9, 0, [1, 1, 1];
}
