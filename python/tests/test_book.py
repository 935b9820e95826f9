"""The programs of the book (docs/book/python) against the robot's functions, a formula and laws."""

import re
import sys
from pathlib import Path

import articulated
import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
BOOK = ROOT / "docs" / "book"
NEAR = 1e-12  # relative to the largest entry
FIXED = [(name, "fixed") for name in ("ur5_like", "panda_like", "double_pendulum", "golfer")]
ROBOTS = FIXED + [("cart_pole", "fixed"), ("quadruped", "floating")]

sys.path.insert(0, str(BOOK / "python"))
import aba
import arm
import bodies
import crba
import laws
import matrices
import mended
import rnea

sys.path.remove(str(BOOK / "python"))


class Pair:
    """A robot of the package, and the same file as the book reads it."""

    def __init__(self, name, base):
        self.ours = articulated.bundled(name, base=base)
        self.book = bodies.read(ROOT / "models" / "urdf" / f"{name}.urdf", base)

    def state(self, seed):
        rng = np.random.default_rng(seed)
        q = self.ours.random_configuration(rng)
        return q, bodies.tree_at(self.book, q), *rng.normal(size=(3, self.ours.nv))

    def wrenches(self, seed):
        """Random ones of all links, those of the package in the order of its frames."""
        book = np.random.default_rng(seed).normal(size=(len(self.book.links), 6))
        ours = np.zeros((len(self.ours.frames), 6))
        ours[[self.ours.frames.index(link.name) for link in self.book.links]] = book
        return book, ours


@pytest.fixture(scope="module", params=ROBOTS, ids=[name for name, _ in ROBOTS])
def pair(request):
    return Pair(*request.param)


def equal(found, expected, near=NEAR):
    assert found.shape == expected.shape
    assert np.abs(found - expected).max() <= near * np.abs(expected).max()


@pytest.mark.parametrize("seed", range(5))
def test_recursions_are_the_robot_s_functions(pair, seed):
    q, tree, v, a, tau = pair.state(seed)
    equal(rnea.rnea(tree, v, a), pair.ours.inverse_dynamics(q, v, a))
    equal(crba.crba(tree), pair.ours.mass_matrix(q))
    equal(aba.aba(tree, v, tau), pair.ours.forward_dynamics(q, v, tau))


def test_wrenches_and_poses_are_the_robot_s(pair):
    q, tree, v, a, tau = pair.state(7)
    book, ours = pair.wrenches(8)
    equal(rnea.rnea(tree, v, a, book), pair.ours.inverse_dynamics_with_wrenches(q, v, a, ours))
    equal(aba.aba(tree, v, tau, book), pair.ours.forward_dynamics_with_wrenches(q, v, tau, ours))
    index = [pair.ours.frames.index(link.name) for link in pair.book.links]
    equal(bodies.placements(pair.book, q), pair.ours.placements_matrices(q)[index])


def test_the_pendulum_has_its_closed_form():
    robot = bodies.read(ROOT / "models" / "urdf" / "simple_pendulum.urdf")
    for q, v, a in np.random.default_rng(0).normal(size=(20, 3)):
        tree = bodies.tree_at(robot, [q])
        tau = 1.001 * a + 9.81 * np.sin(q)
        assert abs(rnea.rnea(tree, [v], [a])[0] - tau) < 1e-14 * 20
        assert abs(aba.aba(tree, [v], [tau])[0] - a) < 1e-14 * 20
        assert abs(crba.crba(tree)[0, 0] - 1.001) < 1e-15


def test_the_serial_arm_is_right():
    """The program that the mistakes are put into, against the robot of the package."""
    pair = Pair("ur5_like", "fixed")
    serial, gravity = arm.arm_of(pair.book), pair.book.gravity
    for seed in range(5):
        q, _, v, a, force = pair.state(seed)
        found, _ = arm.inverse_dynamics(serial, q, v, a, gravity, np.zeros(6))
        equal(found, pair.ours.inverse_dynamics(q, v, a))
        pulled, _ = arm.inverse_dynamics(serial, q, v, a, gravity, np.append(np.zeros(3), force[:3]))
        jacobian = pair.ours.jacobians_world_aligned(q)[pair.ours.frames.index("flange")]
        equal(found - pulled, jacobian[3:].T @ force[:3], 1e-10)


def test_the_product_of_exponentials_has_the_pose_of_the_tip():
    """T_0n = exp([S_1] q_1) … exp([S_n] q_n) M, of screws in axes of the world."""
    pair = Pair("ur5_like", "fixed")
    q = pair.state(3)[0]
    T = np.eye(4)
    for screw, angle in zip(arm.arm_of(pair.book).space, q, strict=True):
        T = T @ matrices.exponential(screw, angle)
    tip = pair.ours.frames.index("flange")
    equal(T @ pair.ours.placements_matrices(0 * q)[tip], pair.ours.placements_matrices(q)[tip])


def test_axes_that_are_turned_in_the_file(tmp_path):
    """Turned axes of inertia and of a slider, and an axis whose length is not one."""
    text = """<robot name="turned"><link name="a"/><link name="b"><inertial><origin xyz="0.1 0.2 -0.3" rpy="0.4 -0.5 0.6"/><mass value="2"/>
    <inertia ixx="0.1" ixy="0.01" ixz="-0.02" iyy="0.12" iyz="0.03" izz="0.15"/></inertial></link><link name="c"><inertial>
    <origin rpy="1 2 3"/><mass value="1.5"/><inertia ixx="0.2" ixy="0" ixz="0" iyy="0.3" iyz="0" izz="0.4"/></inertial></link>
    <joint name="slide" type="prismatic"><parent link="b"/><child link="c"/><origin xyz="1 0 0" rpy="0.3 0.2 0.1"/><axis xyz="1 2 2"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
    <joint name="turn" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 3 4"/></joint></robot>"""
    path = tmp_path / "turned.urdf"
    path.write_text(text, encoding="utf-8")
    with pytest.warns(articulated.RobotWarning, match="axis"):
        ours = articulated.load(path)
    tree = bodies.tree_at(bodies.read(path), [0.7, -0.4])
    equal(crba.crba(tree), ours.mass_matrix([0.7, -0.4]))
    equal(rnea.rnea(tree, [1.0, 2.0], [3.0, 4.0]), ours.inverse_dynamics([0.7, -0.4], [1.0, 2.0], [3.0, 4.0]))


def test_all_eight_mistakes_are_found(capsys):
    assert mended.main([]) == 0
    out = capsys.readouterr().out
    rows = [line for line in out.splitlines() if line[:1].isdigit()]
    assert [row.split()[0] for row in rows] == list("12345678")
    for row, mistake in zip(rows, mended.MISTAKES, strict=True):
        assert mistake.name in row
        right, wrong = (float(number) for number in row.split()[-2:])
        assert right < 1e-9 and wrong > 1e-2
    # The chapter has the second table, and the rows of the first one but for their last digits.
    chapter = (BOOK / "src" / "mended.md").read_text(encoding="utf-8")
    first, marks = out.split("\n\n")
    assert marks in chapter
    for line in first.splitlines()[1:]:
        assert re.sub(r"\S+ +\S+$", "", line) in chapter


def test_a_mistake_that_is_not_found_fails(monkeypatch, capsys):
    first = mended.MISTAKES[0]
    monkeypatch.setattr(mended, "MISTAKES", [first._replace(wrong=first.right)])
    assert mended.main([]) == 1
    assert first.name in capsys.readouterr().err


@pytest.mark.parametrize("mistake", mended.MISTAKES, ids=lambda mistake: mistake.name)
def test_a_wrong_program_fails(mistake, monkeypatch, capsys, tmp_path):
    """Each mistake in `arm.py` itself."""
    source = mended.SOURCE.read_text(encoding="utf-8")
    for right, wrong in zip(mistake.right.split("\n\n"), mistake.wrong.split("\n\n"), strict=True):
        source = source.replace(right.strip(), wrong.strip())
    (tmp_path / "arm.py").write_text(source, encoding="utf-8")
    monkeypatch.setattr(mended, "SOURCE", tmp_path / "arm.py")
    monkeypatch.setattr(mended, "MISTAKES", [])
    assert mended.main([]) == 1
    assert mistake.law.__name__.replace("_", " ") in capsys.readouterr().err


OTHERS = {
    "the momentum term with the wrong sign": (laws.momentum_balance, "- ad(V[i]).T @ G @ V[i]", "+ ad(V[i]).T @ G @ V[i]"),
    "the bias with the wrong sign": (laws.power, "+ ad(V[i]) @ S[i] * v[i]", "- ad(V[i]) @ S[i] * v[i]"),
    "links of one kilogram": (laws.momentum_balance, "inertia(arm.mass[i],", "inertia(1.0,"),
    "a tip wrench with the wrong sign": (laws.virtual_work, "F[n] = -np.append", "F[n] = np.append"),
    "gravity upward": (laws.slope, "= -gravity", "= gravity"),
}


@pytest.mark.parametrize("name", OTHERS)
def test_other_mistakes_are_found(name):
    law, right, wrong = OTHERS[name]
    sizes = mended.violations(mended.Mistake(name, law, right, wrong))
    assert sizes[laws.LAWS.index(law)].min() > mended.BROKEN


def test_the_power_does_not_see_the_sign_of_the_momentum_term():
    sizes = mended.violations(mended.Mistake("", laws.power, *OTHERS["the momentum term with the wrong sign"][1:]))
    assert sizes[laws.LAWS.index(laws.power)].max() < mended.HOLDS


@pytest.mark.parametrize("page", ["numpy.md", "mended.md"])
def test_blocks_of_the_chapters_run(page, monkeypatch):
    monkeypatch.chdir(ROOT)
    text = (BOOK / "src" / page).read_text(encoding="utf-8")
    blocks = re.findall(r"(<!-- quote: \S+ -->\n)?```python\n(.*?)```", text, re.DOTALL)
    own = [block for quote, block in blocks if not quote]
    assert own
    for block in own:
        exec(compile(block, page, "exec"), {})


def pair_of_links(kind, child="b", inside=""):
    joint = f"<joint name='j' type='{kind}'><parent link='a'/><child link='{child}'/>{inside}</joint>"
    return f"<robot><link name='a'/><link name='b'/>{joint}</robot>"


BAD = [
    ("<robot>", "XML with a mistake"),
    ("<robot></robot>", "0 links without a parent, expected one"),
    ("<robot><link name='a'/><link name='b'/></robot>", "2 links without a parent, expected one"),
    ("<robot><link name='a'/><link name='a'/></robot>", "two links of one name"),
    (pair_of_links("planar"), "joint j: found type 'planar', expected fixed, revolute, continuous or prismatic"),
    (pair_of_links("fixed", child="c"), "joint j: found the child c, expected a link of the file"),
    (pair_of_links("fixed", child="a"), "expected a tree"),
    (pair_of_links("fixed", inside="<origin rpy='0 0 nan'/>"), "joint j: found rpy='0 0 nan', expected 3 finite numbers"),
    (pair_of_links("revolute", inside="<mimic/>"), "joint j: found <mimic>"),
    (pair_of_links("revolute", inside="<axis xyz='0 0 0'/>"), "joint j: found the axis 0 0 0"),
    (pair_of_links("revolute", inside="<axis xyz='1 0'/>"), "joint j: found xyz='1 0', expected 3 finite numbers"),
    ("<robot><link name='a'><inertial><mass value='x'/></inertial></link></robot>", "link a: found value='x', expected 1 finite number"),
]


@pytest.mark.parametrize("text, message", BAD)
def test_a_file_with_a_mistake_is_refused(text, message, tmp_path):
    path = tmp_path / "robot.urdf"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ValueError) as error:
        bodies.read(path)
    assert "robot.urdf" in str(error.value) and message in str(error.value)


def test_arguments_of_other_shapes_are_refused():
    robot = bodies.read(ROOT / "models" / "urdf" / "double_pendulum.urdf")
    tree, two, three = bodies.tree_at(robot, [0.1, 0.2]), [0.0] * 2, [0.0] * 3
    for name, call in {
        "q": lambda: bodies.tree_at(robot, three),
        "v": lambda: rnea.rnea(tree, three, two),
        "a": lambda: rnea.rnea(tree, two, three),
        "tau": lambda: aba.aba(tree, two, three),
    }.items():
        with pytest.raises(ValueError, match=re.escape(f"{name}: found shape (3,), expected (2,)")):
            call()
    with pytest.raises(ValueError, match="base: found 'flying'"):
        bodies.read("none.urdf", base="flying")
    with pytest.raises(ValueError, match="expected a chain"):
        arm.arm_of(robot)
    program = laws.Program(lambda *_: (two, None), None, robot)
    with pytest.raises(ValueError, match="momentum_balance: found None"):
        laws.momentum_balance(program, laws.State(*np.ones((3, 2)), np.ones(3)))
