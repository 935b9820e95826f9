

def _numbers(name, value, shape):
    """``value`` as an array of float64 in C order, and its number of states or None."""
    try:
        array = np.asarray(value)
    except (ValueError, TypeError) as error:
        raise ValueError(f"{name}: found no rectangular array ({error}), expected an array of real numbers") from None
    if array.dtype.kind not in "iuf":
        raise TypeError(f"{name}: found dtype {array.dtype}, expected real numbers, such as float64")
    array = np.require(array, dtype=np.float64, requirements=["C", "A"])
    if array.shape != shape and array.shape[1:] != shape or array.ndim == 0 and shape:
        many = "(N" + "".join(f", {n}" for n in shape) + ("," if not shape else "") + ")"
        raise ValueError(f"{name}: found shape {array.shape}, expected {shape} for one state or {many} for N states")
    if not np.isfinite(array).all():
        place = np.argwhere(~np.isfinite(array))[0].tolist()
        raise ValueError(f"{name}: found {array[tuple(place)]} at {place}, expected finite numbers")
    return array, None if array.ndim == len(shape) else len(array)


def _threads(given):
    if given is None:
        return 1
    if isinstance(given, bool) or not hasattr(given, "__index__"):
        raise TypeError(f"threads: found {type(given).__name__}, expected None or 1 for one thread, 0 for all, or a number to 1024")
    count = given.__index__()
    if not 0 <= count <= 1024:
        raise ValueError(f"threads: found {count}, expected None or 1 for one thread, 0 for all, or a number to 1024")
    return count or os.cpu_count() or 1


def _run(function, given, threads):
    name, takes, gives = _FUNCTIONS[function]
    threads = _threads(threads)
    arrays, states = [], None
    for (argument, shape), value in zip(takes, given):
        array, count = _numbers(argument, value, shape)
        arrays.append(array)
        if count is not None and states is None:
            states, first = count, argument
        if count is not None and count != states:
            raise ValueError(f"{argument}: found {count} states, expected {states} as in {first}, or one state for all of them")
    out = np.empty(gives if states is None else (states, *gives))
    count = 1 if states is None else states
    if not out.size:
        return out
    size = out.size // count
    # The step of an argument that is the same for all states is zero.
    steps = [math.prod(shape) if array.ndim > len(shape) else 0 for array, (_, shape) in zip(arrays, takes)]
    loop = _LOOPS[function]

    def part(begin, end):
        places = [array.ctypes.data + 8 * begin * step for array, step in zip(arrays, steps)]
        given = (ctypes.c_void_p * len(places))(*places), (ctypes.c_size_t * len(steps))(*steps)
        loop(end - begin, *given, out.ctypes.data + 8 * begin * size)

    threads = min(threads, count)
    ends = [count * k // threads for k in range(threads + 1)]
    # ctypes releases the interpreter's lock.
    workers = [threading.Thread(target=part, args=ends[k : k + 2]) for k in range(1, threads)]
    for worker in workers:
        worker.start()
    part(*ends[:2])
    for worker in workers:
        worker.join()
    return out if out.ndim else float(out)


_library = ctypes.CDLL(os.path.join(os.path.dirname(os.path.abspath(__file__)), _FILE))
_LOOPS = [_library[f"{_PREFIX}_loop_{name}"] for name, _, _ in _FUNCTIONS]
for _loop in _LOOPS:
    _loop.restype = None
    _loop.argtypes = [ctypes.c_size_t, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p]
