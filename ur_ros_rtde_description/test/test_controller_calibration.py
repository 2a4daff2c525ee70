"""Origins of the joints from the Denavit-Hartenberg parameters of a controller."""

import dataclasses
import math

import numpy as np
import pytest
from ur_ros_rtde_description.calibration import largest_deviation
from ur_ros_rtde_description.controller_calibration import Deviation, calibration_yaml, deviation, origins_from_dh
from ur_ros_rtde_description.errors import DescriptionError
from ur_ros_rtde_description.kinematics import ALPHA, Origin, flange_pose, nominal_origins, rotation
from ur_ros_rtde_description.kinematics_hash import kinematics_hash, std_hash
from ur_ros_rtde_description.models import find_model, models

BACKGROUND = True


@dataclasses.dataclass(frozen=True)
class Dh:
    theta: tuple
    a: tuple
    d: tuple
    alpha: tuple


def nominal(model):
    return Dh((0.0,) * 6, model.a, model.d, ALPHA)


def random_calibration(model, seed, deviation_of_length=3e-4, deviation_of_angle=5e-4):
    random = np.random.default_rng(seed)

    def noise(scale, last):
        return np.append(random.normal(0.0, scale, 5), random.normal(0.0, scale) if last else 0.0)

    return Dh(tuple(noise(deviation_of_angle, True)), tuple(model.a + noise(deviation_of_length, False)),
              tuple(model.d + noise(deviation_of_length, True)), tuple(ALPHA + noise(deviation_of_angle, False)))


def flange(dh, joints):
    """Multiplies the rows as the definition of the parameters says."""
    pose = np.eye(4)
    for q, theta, a, d, alpha in zip(joints, dh.theta, dh.a, dh.d, dh.alpha):
        row = np.eye(4)
        row[:3, :3] = rotation(2, q + theta) @ rotation(0, alpha)
        row[:3, 3] = rotation(2, q + theta) @ (a, 0.0, d)
        pose = pose @ row
    return pose


@pytest.mark.parametrize("name", models())
def test_the_origins_describe_the_same_arm(name):
    model = find_model(name)
    random = np.random.default_rng(1)
    for seed in range(20):
        dh = random_calibration(model, seed)
        origins = origins_from_dh(dh, model)
        for joints in random.uniform(-2 * math.pi, 2 * math.pi, (5, 6)):
            assert flange_pose(origins, joints) == pytest.approx(flange(dh, joints), abs=1e-12)


@pytest.mark.parametrize("name", models())
def test_nominal_parameters_give_the_nominal_origins(name):
    model = find_model(name)
    for origin, expected in zip(origins_from_dh(nominal(model), model), nominal_origins(model)):
        assert (*origin.xyz, *origin.rpy) == pytest.approx((*expected.xyz, *expected.rpy), abs=1e-12)


def test_joint_frames_stay_at_their_joints_if_the_parameters_are_far_away():
    """Almost parallel axes have their common normal far away: d of joint 2 is -12 m, of joint 3 +12 m."""
    model = find_model("ur10e")
    tilt, far = 2e-4, 12.0
    dh = Dh((0.0,) * 6, model.a, (model.d[0], -far, far, *model.d[3:]), (ALPHA[0], tilt, *ALPHA[2:]))
    origins = origins_from_dh(dh, model)
    for joints in np.random.default_rng(2).uniform(-3.0, 3.0, (20, 6)):
        assert flange_pose(origins, joints) == pytest.approx(flange(dh, joints), abs=1e-11)
    for origin, expected in zip(origins, nominal_origins(model)):
        assert np.linalg.norm(np.subtract(origin.xyz, expected.xyz)) < 0.005


def test_the_deviation_is_that_of_the_flange():
    model = find_model("ur5e")
    longer = dataclasses.replace(nominal(model), d=(*model.d[:5], model.d[5] + 0.001))
    assert deviation(longer, "ur5e", None).distance == pytest.approx(0.001)
    turned = dataclasses.replace(nominal(model), theta=(0.0,) * 5 + (0.002,))
    assert deviation(turned, "ur5e", None).angle == pytest.approx(0.002)
    assert not Deviation(0.0, 0.002).is_negligible() and deviation(nominal(model), "ur5e", None).is_negligible()


def test_a_saved_calibration_is_read_back(tmp_path):
    for name in ("ur3", "ur30"):
        model = find_model(name)
        dh = random_calibration(model, 3)
        file = tmp_path / f"{name}.yaml"
        file.write_text(calibration_yaml(dh, model, "two\nlines"))
        assert file.read_text().startswith("# two\n# lines\nkinematics:\n  shoulder:\n")
        assert deviation(dh, name, file) == Deviation(0.0, 0.0)
        assert f"hash: {kinematics_hash(dh.theta, dh.d, dh.a, dh.alpha)}\n" in file.read_text()


def test_the_hash_is_that_of_universal_robots():
    """The hash of the nominal UR5e, which the client library of Universal Robots expects of its simulator."""
    alpha = (1.570796327, 0.0, 0.0, 1.570796327, -1.570796327, 0.0)
    assert kinematics_hash((0.0,) * 6, (0.1625, 0.0, 0.0, 0.1333, 0.0997, 0.0996), (0.0, -0.425, -0.3922, 0.0, 0.0, 0.0),
                           alpha) == "calib_12788084448423163542"


@pytest.mark.parametrize("text, expected", [("", 6142509188972423790), ("a", 4993892634952068459), ("12345678", 10113836418918046885),
                                            ("00.1625001.5708", 1148860220319228980)])
def test_std_hash_is_that_of_libstdcxx(text, expected):
    assert std_hash(text.encode()) == expected


@pytest.mark.parametrize("change, mentions", [({"a": (0.0, math.nan, 0.0, 0.0, 0.0, 0.0)}, "no finite numbers"),
                                              ({"alpha": (*ALPHA[:5], 0.01)}, "of joint 6"),
                                              ({"d": (0.0,) * 6}, "the controller: the calibration does not belong to the model ur5e")])
def test_invalid_parameters_are_rejected(change, mentions):
    model = find_model("ur5e")
    with pytest.raises(DescriptionError, match=mentions):
        origins_from_dh(dataclasses.replace(nominal(model), **change), model)


def test_small_angles_are_measured_exactly():
    origins = nominal_origins(find_model("ur5e"))
    turned = (*origins[:5], Origin(origins[5].xyz, (origins[5].rpy[0], origins[5].rpy[1], 1e-9)))
    assert largest_deviation(turned, origins)[1] == pytest.approx(1e-9, rel=1e-4)
