"""start_recording and stop_recording: each received package becomes a row, and lost packages are counted."""

import csv
import resource
import struct

import pytest
from programs import Process, find_program, start_node
from ros_client import Client
from support import HOME, wait_for

from ur_ros_rtde_msgs.srv import StartRecording, StopRecording

DEFAULT_COLUMNS = ["timestamp", *(f"{name}_{i}" for name in ("actual_q", "actual_qd", "actual_TCP_pose") for i in range(6))]


@pytest.fixture(scope="module")
def receiver(simulator):
    receiver = start_node("robot_state_receiver", simulator.address)
    yield receiver
    receiver.stop()
    print(receiver.output())


def start(client, file, fields=(), **options):
    return client.call(StartRecording, "start_recording", filename=str(file), fields=list(fields), **options)


def stop(client):
    return client.call(StopRecording, "stop_recording")


def start_when_connected(client, file, fields=(), **options):
    """Starts a recording as soon as the robot is connected. Returns its columns."""
    answer = wait_for(lambda: _success(start(client, file, fields, **options)), 15.0, "the recording to start")
    return list(answer.columns)


def _success(answer):
    return answer if answer.success else None


def read_csv(file):
    with open(file, newline="") as text:
        header, *rows = csv.reader(text)
    return header, [[float(number) for number in row] for row in rows]


def count_lines(file):
    return sum(1 for _ in open(file, "rb"))


def test_writes_one_row_per_package(receiver, simulator, client, tmp_path):
    file = tmp_path / "run.csv"
    assert start_when_connected(client, file) == DEFAULT_COLUMNS
    simulator.wait(1.0, 30.0)
    answer = stop(client)
    assert answer.success and answer.filename == str(file), answer.message
    header, rows = read_csv(file)
    assert header == DEFAULT_COLUMNS and len(rows) == answer.rows > 400
    stamps = [row[0] for row in rows]
    assert stamps == sorted(stamps) and len(set(stamps)) == len(stamps)
    # All packages are either recorded or counted as lost.
    assert round((stamps[-1] - stamps[0]) / 0.002) + 1 == answer.rows + answer.lost
    assert rows[0][1:7] == pytest.approx(HOME, abs=0.01)


def test_records_several_files_in_sequence(receiver, simulator, client, tmp_path):
    for number in range(5):
        file = tmp_path / f"{number}.csv"
        assert start_when_connected(client, file, ["actual_q"]) == [f"actual_q_{i}" for i in range(6)]
        wait_for(lambda f=file: count_lines(f) > 10, 10.0, "some rows")
        answer = stop(client)
        assert answer.success and len(read_csv(file)[1]) == answer.rows


def test_numbers_have_full_round_trip_precision(receiver, simulator, client, tmp_path):
    file = tmp_path / "numbers.csv"
    start_when_connected(client, file, ["output_double_register_24", "output_int_register_24", "actual_digital_input_bits"])
    value = struct.unpack("f", struct.pack("f", 0.1 + 0.2))[0]  # registers have 32 bits: 0.30000001192092896
    simulator.control("run_script", script="sec set():\n  write_output_float_register(24, 0.1 + 0.2)\n"
                                           "  write_output_integer_register(24, -123456789)\nend\n")
    wait_for(lambda: count_lines(file) > 1 and "-123456789" in file.read_text(), 10.0, "the registers")
    stop(client)
    with open(file, newline="") as text:
        last = list(csv.reader(text))[-1]
    assert struct.pack("d", float(last[0])) == struct.pack("d", value) and last[1] == "-123456789" and last[2] == "0"


def test_records_at_a_lower_frequency(receiver, simulator, client, tmp_path):
    file = tmp_path / "slow.csv"
    start_when_connected(client, file, ["timestamp"], frequency=50.0)
    simulator.wait(1.0, 30.0)
    answer = stop(client)
    stamps = [row[0] for row in read_csv(file)[1]]
    assert round((stamps[-1] - stamps[0]) * 50.0) + 1 == pytest.approx(answer.rows + answer.lost, abs=1)


@pytest.mark.parametrize("fields, message", [(["actual_position"], '"actual_position" is not an RTDE output'),
                                          (["actual_q", "actual_q"], '"actual_q" occurs twice')])
def test_an_invalid_field_is_rejected_with_its_name(receiver, client, tmp_path, fields, message):
    answer = start(client, tmp_path / "none.csv", fields)
    assert not answer.success and message in answer.message
    assert not (tmp_path / "none.csv").exists()


def test_does_not_overwrite_an_existing_file(receiver, client, tmp_path):
    file = tmp_path / "mine.csv"
    file.write_text("mine")
    answer = wait_for(lambda: (lambda a: a if "exists" in a.message else None)(start(client, file)), 15.0, "the rejection")
    assert not answer.success and str(file) in answer.message and file.read_text() == "mine"


@pytest.mark.parametrize("name, message", [("relative.csv", "relative"), ("", "relative"), ("/nowhere/at/all.csv", "No such file"),
                                        ("/proc/run.csv", "cannot be written")])
def test_an_invalid_filename_is_rejected_with_the_reason(receiver, client, name, message):
    answer = wait_for(lambda: (lambda a: a if message in a.message else None)(start(client, name)), 15.0, "the rejection")
    assert not answer.success


@pytest.mark.parametrize("frequency", [-1.0, 0.5, 501.0, float("nan"), float("inf")])
def test_a_frequency_out_of_range_is_rejected(receiver, client, tmp_path, frequency):
    answer = start(client, tmp_path / "fast.csv", frequency=frequency)
    assert not answer.success and "frequency" in answer.message and "500" in answer.message


def test_a_second_recording_is_rejected(receiver, client, tmp_path):
    start_when_connected(client, tmp_path / "first.csv")
    second = start(client, tmp_path / "second.csv")
    assert not second.success and "first.csv" in second.message and not (tmp_path / "second.csv").exists()
    assert stop(client).success


def test_stop_without_a_recording_fails(receiver, client):
    answer = stop(client)
    assert not answer.success and "nothing is being recorded" in answer.message


def test_start_without_a_robot_fails(addresses, processes, tmp_path):
    processes(start_node("robot_state_receiver", addresses[1], namespace="nowhere"))
    client = Client("nowhere")
    try:
        answer = start(client, tmp_path / "none.csv")
        assert not answer.success and addresses[1] in answer.message and not (tmp_path / "none.csv").exists()
    finally:
        client.close()


def test_continues_after_a_lost_connection_and_counts_the_lost_packages(receiver, simulator, client, tmp_path):
    file = tmp_path / "gap.csv"
    start_when_connected(client, file, ["timestamp"])
    wait_for(lambda: count_lines(file) > 50, 10.0, "some rows")
    before = count_lines(file)
    simulator.control("drop_links", which="rtde")
    wait_for(lambda: count_lines(file) > before + 200, 20.0, "rows after the loss")
    answer = stop(client)
    stamps = [row[0] for row in read_csv(file)[1]]
    assert max(b - a for a, b in zip(stamps, stamps[1:])) > 0.1
    assert answer.success and answer.lost > 50
    assert round((stamps[-1] - stamps[0]) / 0.002) + 1 == answer.rows + answer.lost


def test_shutdown_of_the_node_closes_the_file(simulator, processes, tmp_path):
    receiver = processes(start_node("robot_state_receiver", simulator.address, namespace="ending"))
    client = Client("ending")
    try:
        file = tmp_path / "ending.csv"
        columns = start_when_connected(client, file)
        wait_for(lambda: count_lines(file) > 100, 10.0, "some rows")
        receiver.interrupt()
        assert receiver.wait(15.0) == 0
        header, rows = read_csv(file)
        assert header == columns and all(len(row) == len(columns) for row in rows)
        assert f"{len(rows)} rows" in receiver.output()
    finally:
        client.close()


def test_a_full_disk_is_reported_and_leaves_complete_rows(simulator, processes, tmp_path):
    # If SIGXFSZ is ignored, exceeding the file size limit fails like a full disk.
    command = ["sh", "-c", 'trap "" XFSZ; exec "$@"', "sh", find_program("ur_ros_rtde", "robot_state_receiver")]
    receiver = processes(Process([*command, "--ros-args", "-p", f"robot_ip:={simulator.address}", "-r", "__ns:=/full"]))
    client = Client("full")
    try:
        file = tmp_path / "full.csv"
        columns = start_when_connected(client, file)
        unlimited = resource.prlimit(receiver.pid, resource.RLIMIT_FSIZE, (65536, resource.RLIM_INFINITY))
        receiver.wait_for_output("cannot be written anymore", 30.0)
        simulator.wait(0.2, 30.0)
        answer = stop(client)
        assert not answer.success and "cannot be written anymore" in answer.message
        header, rows = read_csv(file)
        assert len(rows) == answer.rows > 10 and all(len(row) == len(columns) for row in rows) and answer.lost > 0
        resource.prlimit(receiver.pid, resource.RLIMIT_FSIZE, unlimited)
        assert receiver.running()
        assert start_when_connected(client, tmp_path / "next.csv", ["timestamp"]) == ["timestamp"]
    finally:
        client.close()


def test_a_protective_stop_leaves_a_file_of_the_last_2_s(simulator, tmp_path):
    receiver = start_node("robot_state_receiver", simulator.address, namespace="recorded", env={"ROS_LOG_DIR": str(tmp_path)})
    try:
        wait_for(lambda: any("connected to" in line for line in list(receiver.lines)), 15.0, "the connection")
        simulator.control("power", to="running")
        simulator.control("run_script", script=f"def go():\n  movej({[HOME[0] + 2.0, *HOME[1:]]}, a=2.0, v=0.3)\nend\n")
        simulator.wait(3.0, 30.0)
        simulator.control("protective_stop", reason="a test")
        text = "before the PROTECTIVE_STOP are in "
        line = wait_for(lambda: next((line for line in list(receiver.lines) if text in line), None), 15.0, "the file")
        header, rows = read_csv(line.partition(text)[2].partition(": draw")[0])
    finally:
        receiver.stop()
        wait_for(simulator.unlock_protective_stop, 20.0, "the protective stop to be unlocked")
        print(receiver.output())
    times, speeds, modes = ([row[header.index(name)] for row in rows] for name in ("timestamp", "actual_qd_0", "safety_mode"))
    first = modes.index(3.0)
    assert times[first] - times[0] == pytest.approx(2.0, abs=0.1) and times[-1] - times[first] == pytest.approx(0.2, abs=0.1)
    assert speeds[0] == pytest.approx(0.3, abs=0.01) and abs(speeds[-1]) < 0.01
    assert set(modes[first:]) == {3.0}
