#!/usr/bin/env python3
"""What the comparisons with other programs found for each file: docs/site/data/<corpus>.json.

    python3 tests/verdicts.py mjcf [WORD]   the recorded verdicts of a corpus, of packages and files with this word
    python3 tests/verdicts.py --check       the summaries in docs are those of the data, and the packages are the pinned ones
    python3 tests/verdicts.py --write       writes the summaries of docs anew from the data

Corpora: shipped (URDF), mjcf and contact (MJCF), sdf. Their scripts write the data with `--write`:

    python3 tests/shipped/shipped.py --write        python3 tests/mjcf/oracle.py --write
    python3 tests/mjcf/contact.py --all --write     python3 tests/sdf/oracle.py --write

Each run of these scripts compares its verdicts with the recorded ones. Only the packages of a run
are written; the record keeps the others. `--check` needs neither packages nor other programs. The
gallery of robots (docs/site) shows the same data. Exit status: 0, or 1 with `--check` where
something differs.
"""

import argparse
import json
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parent
DATA = REPOSITORY / "docs" / "site" / "data"
# The script that writes a corpus, its list of packages, and the group of files that is no package.
CORPORA = {
    "shipped": ("tests/shipped/shipped.py --write", HERE / "shipped" / "packages.txt", None),
    "mjcf": ("tests/mjcf/oracle.py --write", HERE / "mjcf" / "packages.txt", "files of this folder"),
    "contact": ("tests/mjcf/contact.py --all --write", HERE / "mjcf" / "packages.txt", None),
    "sdf": ("tests/sdf/oracle.py --write", HERE / "sdf" / "packages.txt", "files of tests/sdf"),
}


def pinned(corpus):
    """The packages of a corpus, name==version, in the order of its list."""
    lines = (line.partition("#")[0].strip() for line in CORPORA[corpus][1].read_text(encoding="utf-8").splitlines())
    return [line for line in lines if line]


def read(corpus):
    """The packages of a corpus: each has `files`, with an object for each file, and may have sums
    of its files.

    Each file has a `verdict`, a text. Its first words are a kind: equal, differs, refused, read
    without, not compared, no moving mass. Empty where nothing is recorded.
    """
    path = DATA / f"{corpus}.json"
    if not path.exists():
        return {}
    try:
        return json.loads(path.read_text(encoding="utf-8"))["packages"]
    except (ValueError, KeyError) as error:
        raise SystemExit(f"error: {path}: found {error}, expected the record that `python3 {CORPORA[corpus][0]}` writes") from None


def write(corpus, packages):
    """Records the packages of a run.

    Those that the run left out keep their record; those that are not pinned lose it.
    """
    import verdict_pages

    packages = {**read(corpus), **packages}
    order = [CORPORA[corpus][2], *pinned(corpus)]
    lines = ["{", f' "written_by": {json.dumps("python3 " + CORPORA[corpus][0])},', ' "packages": {']
    blocks = [block(name, packages[name]) for name in order if name in packages]
    DATA.mkdir(parents=True, exist_ok=True)
    (DATA / f"{corpus}.json").write_text("\n".join([*lines, ",\n".join(blocks), " }", "}", ""]), encoding="utf-8")
    verdict_pages.write(corpus)


def block(name, package):
    """The text of a package, with a line for each file."""
    words = [f"   {line(key)}: {line(value)}" for key, value in package.items() if key != "files"]
    files = ",\n".join(f"    {line(file)}: {line(found)}" for file, found in package["files"].items())
    return f"  {line(name)}: {{\n" + ",\n".join([*words, f'   "files": {{\n{files}\n   }}']) + "\n  }"


def line(value):
    return json.dumps(value, ensure_ascii=False, allow_nan=False)


def essence(value):
    """What has to be equal of a finding: of a reason that another program prints, the kind alone,
    since it may name folders of the machine.
    """
    is_foreign = isinstance(value, str) and value.startswith(("refused by ", "not compared: "))
    return value.partition(":")[0] if is_foreign else value


def changed(corpus, packages, keys=("verdict",)):
    """Sentences about files whose findings are not the recorded ones; none where all are."""
    recorded, found = read(corpus), []
    again = f"`python3 {CORPORA[corpus][0]}` records it"
    for name, package in packages.items():
        before, now = recorded.get(name, {}).get("files", {}), package["files"]
        for file in sorted(set(before) | set(now)):
            if file not in now:
                found.append(f"{name}: {file}: recorded, but not in the package; {again}")
            elif file not in before:
                found.append(f"{name}: {file}: {now[file]['verdict']}: not recorded; {again}")
            else:
                found += [f"{name}: {file}: {key}: found {now[file].get(key)!r}, recorded {before[file].get(key)!r}; {again}"
                          for key in keys if essence(now[file].get(key)) != essence(before[file].get(key))]
    return found


def complaints():
    """Sentences about summaries and lists of packages that are not those of the data; none where
    all are.
    """
    import verdict_pages

    found = []
    for corpus, (script, listed, own) in CORPORA.items():
        recorded = set(read(corpus)) - {own}
        for name in sorted(recorded ^ set(pinned(corpus))):
            where = "recorded, but not listed" if name in recorded else "listed, but not recorded"
            found.append(f"{DATA / corpus}.json and {listed}: {name}: {where}; `python3 {script}` records the listed packages")
    return found + verdict_pages.complaints()


def show(corpus, word):
    """Prints a line for each file."""
    count = 0
    for name, package in read(corpus).items():
        for file, found in package["files"].items():
            if word.lower() in f"{name} {file}".lower():
                rest = ", ".join(f"{key} {value}" for key, value in found.items() if key != "verdict" and value not in (None, ""))
                print(f"{name}  {file}  {found['verdict']}" + (f"  ({rest})" if rest else ""))
                count += 1
    if not count:
        raise SystemExit(f"error: {corpus}: found no file of a package with {word!r} in its name; without a word all files are listed")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("corpus", nargs="?", choices=list(CORPORA), help="list the files of this corpus")
    parser.add_argument("word", nargs="?", default="", help="only packages and files with this word")
    parser.add_argument("--check", action="store_true", help="check the summaries in docs")
    parser.add_argument("--write", action="store_true", help="write the summaries in docs")
    arguments = parser.parse_args()
    if arguments.write:
        import verdict_pages

        for corpus in CORPORA:
            verdict_pages.write(corpus)
    if arguments.corpus:
        show(arguments.corpus, arguments.word)
    elif not (arguments.check or arguments.write):
        parser.error("found nothing to do, expected a corpus, --check or --write")
    wrong = complaints() if arguments.check else []
    print(*wrong, sep="\n", end="\n" if wrong else "")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
