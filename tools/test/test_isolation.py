import os
import subprocess
import sys

from ur_tools import isolation


def test_concurrent_domains_differ():
    with isolation.Domain() as first, isolation.Domain() as second:
        assert first.number != second.number
        assert 1 <= min(first.number, second.number) and max(first.number, second.number) <= isolation.LAST_DOMAIN
        assert first.environment()["UR_TEST_ADDRESS"] != second.environment()["UR_TEST_ADDRESS"]


def test_does_not_reserve_a_domain_of_another_process():
    code = ("import sys; sys.path[:0] = %r\n"
            "from ur_tools.isolation import Domain\n"
            "with Domain() as domain:\n"
            "    print(domain.number, flush=True)\n"
            "    sys.stdin.readline()\n" % sys.path)
    other = subprocess.Popen([sys.executable, "-c", code], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                             universal_newlines=True)
    taken = int(other.stdout.readline())
    with isolation.Domain() as domain:
        assert domain.number != taken
    other.communicate("\n", timeout=20.0)


def test_clean_up_removes_only_unused_shared_memory_of_the_run(tmp_path, monkeypatch):
    monkeypatch.setattr(isolation, "_SHARED_MEMORY", tmp_path)
    monkeypatch.setattr(isolation, "_kill_stray_processes", lambda: None)
    (tmp_path / "fastrtps_old").write_text("")
    with isolation.CleanUp():
        (tmp_path / "fastrtps_orphan").write_text("")
        (tmp_path / "someone_elses").write_text("")
    assert sorted(os.listdir(tmp_path)) == ["fastrtps_old", "someone_elses"]


def test_a_fresh_folder_is_empty(tmp_path):
    folder = tmp_path / "logs"
    folder.mkdir()
    (folder / "old").write_text("")
    assert list(isolation.fresh_folder(folder).iterdir()) == []
