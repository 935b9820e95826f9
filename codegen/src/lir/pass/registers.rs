//! Values in registers and values in memory at each step: the value that is needed last is spilled
//! (L. A. Belady, "A study of replacement algorithms for a virtual-storage computer", IBM Systems
//! Journal 5 (2), 1966).

/// Values that are held in registers. Intermediate results of an instruction have the other two.
const REGISTERS: usize = 14;

/// A value that is needed again within this many steps is loaded into a register. Others are read
/// from memory where they are needed.
const SOON: usize = 8;

/// Values that a step needs and defines, by their numbers.
#[derive(Clone, Debug, Default)]
pub(crate) struct Step {
    /// The values that it makes and that may be spilled.
    pub(crate) defined: Vec<usize>,
    /// The values that it needs, each once.
    pub(crate) used: Vec<usize>,
    /// Those of them that may be an operand in memory, of which an instruction has one.
    pub(crate) foldable: Vec<usize>,
}

/// The steps that need each value, in order.
pub(crate) struct Uses(Vec<Vec<usize>>);

impl Uses {
    pub(crate) fn of(steps: &[Step]) -> Self {
        let values = steps.iter().flat_map(|step| step.defined.iter().chain(&step.used)).map(|k| k + 1).max().unwrap_or(0);
        let mut uses = Self(vec![Vec::new(); values]);
        for (at, step) in steps.iter().enumerate() {
            step.used.iter().for_each(|&k| uses.0[k].push(at));
        }
        uses
    }

    /// The next step after `at` that needs a value.
    fn next(&self, k: usize, at: usize) -> Option<usize> {
        let uses = &self.0[k];
        uses.get(uses.partition_point(|&other| other <= at)).copied()
    }

    /// Whether no step after `at` needs it.
    pub(crate) fn is_over(&self, k: usize, at: usize) -> bool {
        self.next(k, at).is_none()
    }

    /// Average number of steps between two uses of it, from `at` on.
    pub(crate) fn rarity(&self, k: usize, at: usize) -> usize {
        self.0[k].last().map_or(0, |last| (last - at) / self.0[k].len())
    }
}

/// The values that are spilled, and where each is loaded.
#[derive(Debug)]
pub(crate) struct Plan {
    /// Whether each value is spilled, by the step that makes it.
    pub(crate) spilled: Vec<bool>,
    /// The values that are loaded into registers before each step.
    pub(crate) loads: Vec<Vec<usize>>,
    /// The operand of each that stays in memory.
    pub(crate) folded: Vec<Option<usize>>,
}

impl Plan {
    pub(crate) fn of(steps: &[Step], uses: &Uses) -> Self {
        let values = uses.0.len();
        let mut may_wait = vec![false; values];
        steps.iter().flat_map(|step| &step.defined).for_each(|&k| may_wait[k] = true);
        let mut plan = Self { spilled: vec![false; values], loads: Vec::new(), folded: Vec::new() };
        let mut held: Vec<usize> = Vec::new();
        for (at, step) in steps.iter().enumerate() {
            let mut missing: Vec<usize> = step.used.iter().copied().filter(|k| may_wait[*k] && !held.contains(k)).collect();
            missing.sort_by_key(|&k| later(uses, k, at));
            let folded = missing.pop_if(|k| step.foldable.contains(k) && later(uses, *k, at) >= at + SOON);
            held.extend(&missing);
            plan.make_room(&mut held, uses, at, &step.used);
            held.retain(|&k| !uses.is_over(k, at));
            held.extend(step.defined.iter().filter(|k| !uses.is_over(**k, at)));
            plan.make_room(&mut held, uses, at, &[]);
            plan.loads.push(missing);
            plan.folded.push(folded);
        }
        plan
    }

    /// Spills values, except those of `kept`, until the rest fits into the registers.
    fn make_room(&mut self, held: &mut Vec<usize>, uses: &Uses, at: usize, kept: &[usize]) {
        while held.len() > REGISTERS {
            let candidates = held.iter().enumerate().filter(|(_, k)| !kept.contains(k));
            let Some((last, _)) = candidates.max_by_key(|(_, k)| later(uses, **k, at)) else { return };
            let k = held.swap_remove(last);
            self.spilled[k] |= !uses.is_over(k, at);
        }
    }
}

/// The next step after `at` that needs a value, beyond all steps if none does.
fn later(uses: &Uses, k: usize, at: usize) -> usize {
    uses.next(k, at).unwrap_or(usize::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A pseudo-random program: each step makes a value of up to three before it.
    fn program(n: usize) -> Vec<Step> {
        let mut seed = 7_u64;
        let mut random = |below: usize| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 33) as usize % below
        };
        let mut step = |k: usize| {
            let mut used: Vec<usize> = if k < 20 { Vec::new() } else { (0..3).map(|_| k - 1 - random(k.min(200))).collect() };
            used.sort_unstable();
            used.dedup();
            Step { defined: vec![k], foldable: used.clone(), used }
        };
        (0..n).map(&mut step).collect()
    }

    /// Executes a plan and checks that each operand is where the plan says. Returns the largest
    /// number of full registers.
    fn carried_out(steps: &[Step], uses: &Uses, plan: &Plan) -> usize {
        let (mut known, mut most) = (Vec::new(), 0);
        for (at, step) in steps.iter().enumerate() {
            for &k in plan.loads[at].iter().chain(&plan.folded[at]) {
                assert!(plan.spilled[k], "step {at}: {k} is read from where it never was");
            }
            known.extend(&plan.loads[at]);
            for k in &step.used {
                assert!(known.contains(k) || plan.folded[at] == Some(*k), "step {at}: {k} is nowhere");
            }
            known.extend(&step.defined);
            // A value that is next read from memory needs no register until then.
            let next = |k: usize| (at + 1..steps.len()).find(|&s| steps[s].used.contains(&k));
            known.retain(|&k| next(k).is_some_and(|s| !plan.loads[s].contains(&k) && plan.folded[s] != Some(k)));
            most = most.max(known.len());
        }
        assert!(uses.is_over(0, steps.len()));
        most
    }

    /// How many times spilled values are read.
    fn reads(plan: &Plan) -> usize {
        plan.loads.iter().map(Vec::len).sum::<usize>() + plan.folded.iter().flatten().count()
    }

    #[test]
    fn every_operand_is_in_a_register_or_waits_and_registers_suffice() {
        let steps = program(1000);
        let uses = Uses::of(&steps);
        let plan = Plan::of(&steps, &uses);
        let spills = plan.spilled.iter().filter(|spilled| **spilled).count();
        assert!(spills > 100 && reads(&plan) >= spills);
        assert_eq!(carried_out(&steps, &uses, &plan), REGISTERS);
    }

    #[test]
    fn nothing_waits_where_registers_suffice() {
        let steps: Vec<Step> =
            (0..100).map(|k: usize| Step { defined: vec![k], used: (k.saturating_sub(3)..k).collect(), foldable: Vec::new() }).collect();
        let plan = Plan::of(&steps, &Uses::of(&steps));
        assert!(!plan.spilled.contains(&true) && reads(&plan) == 0);
    }
}
