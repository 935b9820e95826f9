"""Arrays of other libraries, shared without a copy (DLPack)."""

import articulated
import numpy as np
import pytest
from articulated._errors import as_numbers

ROBOT = articulated.bundled("panda_like")
Q = ROBOT.random_configuration(0, 5)


class Foreign:
    """An array of another library: DLPack's methods and no others."""

    def __init__(self, array, device=(1, 0)):
        self.array, self.on = array, device

    def __dlpack__(self, **options):
        return self.array.__dlpack__(**options)

    def __dlpack_device__(self):
        return self.on


def test_arrays_of_other_libraries_are_used_without_a_copy():
    shared = as_numbers("q", Foreign(Q))
    assert np.shares_memory(shared, Q) and shared.dtype == np.float64
    np.testing.assert_array_equal(ROBOT.gravity_torque(Foreign(Q)), ROBOT.gravity_torque(Q))
    np.testing.assert_array_equal(ROBOT.gravity_torque(Foreign(Q[0])), ROBOT.gravity_torque(Q[0]))
    # Other numbers and layouts are converted.
    single = Q.astype(np.float32)
    np.testing.assert_array_equal(ROBOT.gravity_torque(Foreign(single)), ROBOT.gravity_torque(single))
    np.testing.assert_array_equal(ROBOT.gravity_torque(Foreign(np.asfortranarray(Q))), ROBOT.gravity_torque(Q))


def test_arrays_that_cannot_be_shared():
    with pytest.raises(TypeError, match="q: found Foreign on device kind 2 of DLPack, expected one on the CPU"):
        ROBOT.gravity_torque(Foreign(Q, (2, 0)))
    with pytest.raises(ValueError, match="q: found shape \\(6,\\)"):
        ROBOT.gravity_torque(Foreign(np.zeros(6)))
    with pytest.raises(TypeError, match="q: found dtype complex128"):
        ROBOT.gravity_torque(Foreign(np.zeros(7, complex)))

    class Broken(Foreign):
        def __dlpack__(self, **options):
            raise BufferError("not now")

    with pytest.raises(TypeError, match="q: found"):
        ROBOT.gravity_torque(Broken(Q))


def test_results_are_given_away_without_a_copy():
    mass = ROBOT.mass_matrix(Q[0])
    assert mass.__dlpack_device__() == (1, 0) and np.shares_memory(np.from_dlpack(mass), mass)


def test_tensors_of_torch():
    torch = pytest.importorskip("torch", reason="PyTorch (pip install torch) is not installed")
    tensor = torch.from_numpy(Q.copy())
    assert as_numbers("q", tensor).ctypes.data == tensor.data_ptr()
    tau = torch.from_dlpack(ROBOT.gravity_torque(tensor))
    assert tau.dtype == torch.float64
    np.testing.assert_array_equal(tau.numpy(), ROBOT.gravity_torque(Q))
    with pytest.raises(TypeError, match="q: found Tensor .*requires grad"):
        ROBOT.gravity_torque(torch.zeros(7, dtype=torch.float64, requires_grad=True))


def test_arrays_of_jax():
    jax = pytest.importorskip("jax", reason="JAX (pip install jax) is not installed")
    jax.config.update("jax_enable_x64", True)
    array = jax.numpy.asarray(Q)
    assert as_numbers("q", array).ctypes.data == array.unsafe_buffer_pointer()
    np.testing.assert_array_equal(ROBOT.gravity_torque(array), ROBOT.gravity_torque(Q))
    np.testing.assert_array_equal(jax.dlpack.from_dlpack(ROBOT.gravity_torque(Q)), ROBOT.gravity_torque(Q))
