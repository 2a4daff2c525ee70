"""./ur bench --servers: what the actions of a driver cost."""

import os

from ur_tools import bench, bench_rows, bench_servers
from ur_tools.layout import Layout

ADDRESS = os.environ.get("UR_TEST_ADDRESS", "127.0.1.204")


def test_an_action_that_nobody_uses_costs_one_endpoint(monkeypatch):
    monkeypatch.setattr(bench_servers, "KILLED_CLIENTS", 2)
    monkeypatch.setattr(bench_servers, "NEW_CLIENTS", 3)
    options = bench.parse(["--servers", "--address", ADDRESS])
    figures, _ = bench_servers.measure(Layout.of_environment(), options)
    rows = [row for row in bench_rows.ROWS if row.name.startswith("servers:=")]
    assert len(rows) == len(bench_rows.SERVERS) * len(bench_rows.SERVER_PARTS)
    assert all(bench_rows.value(figures, row) is not None for row in rows), figures
    endpoints = {servers: figures[bench_rows.servers_name(servers, "")]["endpoints"] for servers in bench_rows.SERVERS}
    assert endpoints["on_demand"] < 0.4 * endpoints["always"], endpoints
