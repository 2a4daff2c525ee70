"""start_recording, stop_recording: every package that was wanted is a row, and what is not is counted."""

import csv
import resource
import struct

import pytest
from support import HOME, Client, Process, find_program, start_node, wait_for

from ur_ros_rtde_msgs.srv import StartRecording, StopRecording

DEFAULT = ["timestamp", *(f"{name}_{i}" for name in ("actual_q", "actual_qd", "actual_TCP_pose") for i in range(6))]


@pytest.fixture(scope="module")
def receiver(simulator):
    receiver = start_node("robot_state_receiver", simulator.address)
    yield receiver
    receiver.stop()
    print(receiver.output())


def start(client, file, fields=(), **more):
    return client.call(StartRecording, "start_recording", filename=str(file), fields=list(fields), **more)


def stop(client):
    return client.call(StopRecording, "stop_recording")


def begun(client, file, fields=(), **more):
    """Columns of a recording that runs, once the robot is there."""
    answer = wait_for(lambda: _success(start(client, file, fields, **more)), 15.0, "the recording to begin")
    return list(answer.columns)


def _success(answer):
    return answer if answer.success else None


def head_and_rows(file):
    with open(file, newline="") as text:
        head, *rows = csv.reader(text)
    return head, [[float(number) for number in row] for row in rows]


def pass_time(simulator, seconds):
    begin = simulator.state()["timestamp"]
    wait_for(lambda: simulator.state()["timestamp"] >= begin + seconds, 30.0, f"{seconds} s of the simulator's time")


def lines(file):
    return sum(1 for _ in open(file, "rb"))


def test_each_package_is_a_row(receiver, simulator, client, tmp_path):
    file = tmp_path / "run.csv"
    assert begun(client, file) == DEFAULT
    pass_time(simulator, 1.0)
    answer = stop(client)
    assert answer.success and answer.filename == str(file), answer.message
    head, rows = head_and_rows(file)
    assert head == DEFAULT and len(rows) == answer.rows > 400
    stamps = [row[0] for row in rows]
    assert stamps == sorted(stamps) and len(set(stamps)) == len(stamps)
    # None is missing but those that are counted.
    assert round((stamps[-1] - stamps[0]) / 0.002) + 1 == answer.rows + answer.lost
    assert rows[0][1:7] == pytest.approx(HOME, abs=0.01)


def test_recordings_can_follow_one_another(receiver, simulator, client, tmp_path):
    for number in range(5):
        file = tmp_path / f"{number}.csv"
        assert begun(client, file, ["actual_q"]) == [f"actual_q_{i}" for i in range(6)]
        wait_for(lambda f=file: lines(f) > 10, 10.0, "some rows")
        answer = stop(client)
        assert answer.success and len(head_and_rows(file)[1]) == answer.rows


def test_numbers_are_read_as_what_they_were(receiver, simulator, client, tmp_path):
    file = tmp_path / "numbers.csv"
    begun(client, file, ["output_double_register_24", "output_int_register_24", "actual_digital_input_bits"])
    value = 0.1 + 0.2  # 0.30000000000000004
    simulator.control("run_script", script="sec set():\n  write_output_float_register(24, 0.1 + 0.2)\n"
                                           "  write_output_integer_register(24, -123456789)\nend\n")
    wait_for(lambda: lines(file) > 1 and "-123456789" in file.read_text(), 10.0, "the registers")
    stop(client)
    with open(file, newline="") as text:
        last = list(csv.reader(text))[-1]
    assert struct.pack("d", float(last[0])) == struct.pack("d", value) and last[1] == "-123456789" and last[2] == "0"


def test_a_slower_rate_can_be_chosen(receiver, simulator, client, tmp_path):
    file = tmp_path / "slow.csv"
    begun(client, file, ["timestamp"], frequency=50.0)
    pass_time(simulator, 1.0)
    answer = stop(client)
    stamps = [row[0] for row in head_and_rows(file)[1]]
    assert round((stamps[-1] - stamps[0]) * 50.0) + 1 == pytest.approx(answer.rows + answer.lost, abs=1)


@pytest.mark.parametrize("fields, said", [(["actual_position"], '"actual_position" is not an RTDE output'),
                                          (["actual_q", "actual_q"], '"actual_q" occurs twice')])
def test_a_field_that_there_is_not_is_refused_by_its_name(receiver, client, tmp_path, fields, said):
    answer = start(client, tmp_path / "none.csv", fields)
    assert not answer.success and said in answer.message
    assert not (tmp_path / "none.csv").exists()


def test_a_file_that_exists_is_not_overwritten(receiver, client, tmp_path):
    file = tmp_path / "mine.csv"
    file.write_text("mine")
    answer = wait_for(lambda: (lambda a: a if "exists" in a.message else None)(start(client, file)), 15.0, "the refusal")
    assert not answer.success and str(file) in answer.message and file.read_text() == "mine"


@pytest.mark.parametrize("name, said", [("relative.csv", "relative"), ("", "relative"), ("/nowhere/at/all.csv", "No such file"),
                                        ("/proc/run.csv", "cannot be written")])
def test_a_file_that_cannot_be_is_refused_with_the_reason(receiver, client, name, said):
    answer = wait_for(lambda: (lambda a: a if said in a.message else None)(start(client, name)), 15.0, "the refusal")
    assert not answer.success


@pytest.mark.parametrize("frequency", [-1.0, 0.5, 501.0, float("nan"), float("inf")])
def test_a_frequency_out_of_range_is_refused(receiver, client, tmp_path, frequency):
    answer = start(client, tmp_path / "fast.csv", frequency=frequency)
    assert not answer.success and "frequency" in answer.message and "500" in answer.message


def test_there_is_one_recording_at_a_time(receiver, client, tmp_path):
    begun(client, tmp_path / "first.csv")
    second = start(client, tmp_path / "second.csv")
    assert not second.success and "first.csv" in second.message and not (tmp_path / "second.csv").exists()
    assert stop(client).success


def test_there_is_nothing_to_stop_without_a_recording(receiver, client):
    answer = stop(client)
    assert not answer.success and "nothing is being recorded" in answer.message


def test_without_a_robot_nothing_is_begun(addresses, processes, tmp_path):
    processes(start_node("robot_state_receiver", addresses[1], namespace="nowhere"))
    client = Client("nowhere")
    try:
        answer = start(client, tmp_path / "none.csv")
        assert not answer.success and addresses[1] in answer.message and not (tmp_path / "none.csv").exists()
    finally:
        client.close()


def test_a_lost_link_is_bridged_and_its_packages_are_counted(receiver, simulator, client, tmp_path):
    file = tmp_path / "gap.csv"
    begun(client, file, ["timestamp"])
    wait_for(lambda: lines(file) > 50, 10.0, "some rows")
    before = lines(file)
    simulator.control("drop_links", which="rtde")
    wait_for(lambda: lines(file) > before + 200, 20.0, "rows after the loss")
    answer = stop(client)
    stamps = [row[0] for row in head_and_rows(file)[1]]
    assert max(b - a for a, b in zip(stamps, stamps[1:])) > 0.1
    assert answer.success and answer.lost > 50
    assert round((stamps[-1] - stamps[0]) / 0.002) + 1 == answer.rows + answer.lost


def test_the_end_of_the_node_closes_the_file(simulator, client, processes, tmp_path):
    receiver = processes(start_node("robot_state_receiver", simulator.address, namespace="ending"))
    own = Client("ending")
    try:
        file = tmp_path / "ending.csv"
        columns = begun(own, file)
        wait_for(lambda: lines(file) > 100, 10.0, "some rows")
        receiver.interrupt()
        assert receiver.wait(15.0) == 0
        head, rows = head_and_rows(file)
        assert head == columns and all(len(row) == len(columns) for row in rows)
        assert f"{len(rows)} rows" in receiver.output()
    finally:
        own.close()


def test_a_full_disk_ends_the_file_with_a_whole_row_and_is_told(simulator, processes, tmp_path):
    # The limit of the size of files looks to a program as a full disk does, once its signal is ignored.
    ignoring = ["sh", "-c", 'trap "" XFSZ; exec "$@"', "sh", find_program("ur_ros_rtde", "robot_state_receiver")]
    receiver = processes(Process([*ignoring, "--ros-args", "-p", f"robot_ip:={simulator.address}", "-r", "__ns:=/full"]))
    client = Client("full")
    try:
        file = tmp_path / "full.csv"
        columns = begun(client, file)
        unlimited = resource.prlimit(receiver.pid, resource.RLIMIT_FSIZE, (65536, resource.RLIM_INFINITY))
        receiver.wait_for_output("cannot be written any more", 30.0)
        pass_time(simulator, 0.2)
        answer = stop(client)
        assert not answer.success and "cannot be written any more" in answer.message
        head, rows = head_and_rows(file)
        assert len(rows) == answer.rows > 10 and all(len(row) == len(columns) for row in rows) and answer.lost > 0
        resource.prlimit(receiver.pid, resource.RLIMIT_FSIZE, unlimited)
        assert receiver.running()
        assert begun(client, tmp_path / "next.csv", ["timestamp"]) == ["timestamp"]
    finally:
        client.close()
