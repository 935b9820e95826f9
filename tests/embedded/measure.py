#!/usr/bin/env python3
"""Generated C on microcontrollers and in WebAssembly: instructions of a call, size of its code, stack.

    python3 tests/embedded/measure.py [COMMAND]     COMMAND: the articulated command; built if absent

Cortex-M4F and M7 are emulated by QEMU, which counts instructions, not cycles. WebAssembly runs in node. Every result is compared with that of
the same C on this machine. Needs gcc-arm-none-eabi and qemu-system-arm, or clang, lld and node (packages of Debian); what is not installed
is not run, and named.
"""

import shutil
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from programs import build_command  # noqa: E402

REPOSITORY = HERE.parent.parent
CALLS = 200  # as in main.c
INSTRUCTIONS_PER_TICK = 40  # the boards' clock is 25 MHz, and QEMU takes an instruction for a nanosecond

# robot, base, function, arguments, numbers of the result
SUBJECTS = [
    ("ur5_like", False, "inverse_dynamics", "q, v, a", 6, 6, 6),
    ("ur5_like", False, "forward_dynamics", "q, v, a", 6, 6, 6),
    ("ur5_like", False, "mass_matrix", "q", 6, 6, 36),
    ("quadruped", True, "inverse_dynamics", "q, v, a", 19, 18, 18),
    ("quadruped", True, "forward_dynamics", "q, v, a", 19, 18, 18),
]
BOARDS = [("Cortex-M4F", "cortex-m4", "fpv4-sp-d16", "mps2-an386"), ("Cortex-M7", "cortex-m7", "fpv5-sp-d16", "mps2-an500")]
WARNINGS = ["-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror"]
WASM_LIMIT = 20_000  # bytes


def generate(command, robot, function, level, folder):
    """The name of the header in the folder, without `.h`."""
    name = f"{robot}_{level}"
    words = ["generate", robot, "--language", "c", "--no-libm", "--level", level, "--functions", function, "--prefix", name]
    subprocess.run([*command, *words, "-o", str(folder / f"{name}.h")], check=True, cwd=REPOSITORY)
    return name


def definitions(name, subject):
    _, floating, function, arguments, nq, nv, numbers = subject
    values = {"HEADER": f'"{name}.h"', "FUNCTION": f"{name}_{function}", "NQ": nq, "NV": nv, "NUMBERS": numbers, "ARGUMENTS": arguments}
    return [f"-D{key}={value}" for key, value in values.items()] + ["-DFLOATING"] * floating


def here(folder, name, subject):
    """The result on this machine, in single precision."""
    main = (HERE / "main.c").read_text()
    fill = main[main.index("    for (int k = 0; k < NQ") : main.index("    SYST_RVR")]
    (folder / "here.c").write_text(
        f"#include HEADER\n#include <stdio.h>\nstatic float q[NQ], v[NV], a[NV], out[NUMBERS];\nint main(void) {{\n{fill}"
        "    FUNCTION(ARGUMENTS, out);\n    for (int k = 0; k < NUMBERS; k++) {\n        printf(\"%.9g\\n\", (double)out[k]);\n    }\n    return 0;\n}\n"
    )
    subprocess.run(["cc", "-std=c99", "-O1", "-ffp-contract=off", *definitions(name, subject), f"-I{folder}", folder / "here.c", "-o", folder / "here"],
                   check=True)
    return [float(x) for x in subprocess.run([folder / "here"], check=True, capture_output=True, text=True).stdout.split()]


def far(found, expected):
    assert len(found) == len(expected), (found, expected)
    return max(abs(x - y) for x, y in zip(found, expected)) / max(map(abs, expected))


def microcontrollers(command):
    missing = [tool for tool in ("arm-none-eabi-gcc", "qemu-system-arm") if not shutil.which(tool)]
    if missing:
        print(f"not run: microcontrollers, which need {' and '.join(missing)} (Debian: gcc-arm-none-eabi, qemu-system-arm)")
        return
    print("| processor | robot | function, f32 | instructions | code, bytes | stack, bytes |\n|---|---|---|--:|--:|--:|")
    for processor, cpu, fpu, machine in BOARDS:
        for subject in SUBJECTS:
            robot, _, function = subject[:3]
            with tempfile.TemporaryDirectory() as name:
                folder = Path(name)
                header = generate(command, robot, function, "f32", folder)
                flags = [f"-mcpu={cpu}", "-mthumb", "-mfloat-abi=hard", f"-mfpu={fpu}", "-O2", "-std=gnu99", "-ffunction-sections"]
                flags += ["-fno-math-errno", "-ffp-contract=fast", "-fstack-usage", "-fno-builtin", "-nostdlib", f"-I{folder}", *definitions(header, subject)]
                image = folder / "image.elf"
                # Not inlined, so that its code and its stack are its own.
                text = (folder / f"{header}.h").read_text().replace("static inline", "__attribute__((noinline, used)) static")
                (folder / f"{header}.h").write_text(text)
                subprocess.run(["arm-none-eabi-gcc", *flags, *WARNINGS, HERE / "main.c", "-T", HERE / "cortex_m.ld", "-lgcc", "-o", image],
                               check=True, cwd=folder)
                run = ["qemu-system-arm", "-M", machine, "-nographic", "-semihosting", "-icount", "shift=0", "-kernel", str(image)]
                answer = subprocess.run(run, check=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=120)
                lines = answer.stdout.split()  # the console of the debugger
                found = [struct.unpack("<f", struct.pack("<I", int(x)))[0] for x in lines[1:]]
                error = far(found, here(folder, header, subject))
                assert error < 1e-5, f"{processor}, {robot}, {function}: differs by {error:.1e} of the largest number"
                sizes = subprocess.run(["arm-none-eabi-nm", "--print-size", "--radix=d", image], check=True, capture_output=True, text=True).stdout
                code = sum(int(line.split()[1]) for line in sizes.splitlines() if len(line.split()) == 4 and line.split()[3].startswith(header))
                usage = next(folder.glob("*.su")).read_text().splitlines()
                stack = sum(int(line.split("\t")[1]) for line in usage if f":{header}_" in line)
                print(f"| {processor} | `{robot}` | `{function}` | {int(lines[0]) * INSTRUCTIONS_PER_TICK // CALLS} | {code} | {stack} |", flush=True)


def webassembly(command):
    linker = next((tool for tool in ("wasm-ld", "wasm-ld-14", "wasm-ld-15", "wasm-ld-16") if shutil.which(tool)), None)
    missing = [what for what, there in (("clang", shutil.which("clang")), ("wasm-ld", linker), ("node", shutil.which("node"))) if not there]
    if missing:
        print(f"not run: WebAssembly, which needs {' and '.join(missing)} (Debian: clang, lld, nodejs)")
        return
    subject = SUBJECTS[0]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        header = generate(command, subject[0], subject[2], "f32", folder)
        (folder / "module.c").write_text(
            f'#include "{header}.h"\n__attribute__((export_name("arguments"))) float *arguments(void) {{\n    static float numbers[64];\n'
            f"    return numbers;\n}}\n__attribute__((export_name(\"run\"))) void run(float *x) {{\n    {header}_{subject[2]}(x, x + 6, x + 12, x + 18);\n}}\n"
        )
        module = folder / "module.wasm"
        subprocess.run(["clang", "--target=wasm32", "-std=c99", "-O2", "-nostdlib", "-ffp-contract=off", *WARNINGS, "-c", folder / "module.c",
                        "-o", folder / "module.o"], check=True)
        subprocess.run([linker, "--no-entry", "--strip-all", folder / "module.o", "-o", module], check=True)
        script = """
            const bytes = require('fs').readFileSync(process.argv[1]);
            const { exports } = new WebAssembly.Instance(new WebAssembly.Module(bytes));
            const at = exports.arguments(), x = new Float32Array(exports.memory.buffer, at, 24), f = Math.fround;
            for (let k = 0; k < 6; k++) {
                x[k] = f(f(0.1) * (k + 1));
                x[6 + k] = f(f(0.2) - f(f(0.1) * k));
                x[12 + k] = f(f(f(0.3) * k) - f(0.5));
            }
            exports.run(at);
            console.log(Array.from(x.slice(18)).join(' '));
        """
        answer = subprocess.run(["node", "-e", script, str(module)], check=True, capture_output=True, text=True).stdout
        error = far([float(x) for x in answer.split()], here(folder, header, subject))
        size = module.stat().st_size
    print(f"WebAssembly: `{subject[2]}` of `{subject[0]}`, f32: a module of {size} bytes, which differs from this machine by {error:.1e} of the largest number")
    assert error < 1e-6 and size < WASM_LIMIT


if __name__ == "__main__":
    program = sys.argv[1:] or [build_command()]
    microcontrollers(program)
    webassembly(program)
