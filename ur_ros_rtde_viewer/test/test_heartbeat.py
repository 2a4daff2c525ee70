"""The heartbeat of the page, without a browser."""

from ur_ros_rtde_viewer.page.heartbeat import Heartbeat


def test_the_page_keeps_only_the_newest_beat(server):
    buffer = server._websock_server._broadcast_buffer
    heartbeat = Heartbeat(server.gui)
    heartbeat.beat()
    count, contents = len(buffer.message_from_id), {heartbeat._element.content}
    for _ in range(2000):
        heartbeat.beat()
        contents.add(heartbeat._element.content)
    assert len(buffer.message_from_id) == count and len(contents) > 100
    assert max(map(len, contents)) <= min(map(len, contents)) + 2


def test_answers_change_the_element_beside_the_beat(server):
    heartbeat = Heartbeat(server.gui)
    heartbeat.beat()
    before = heartbeat._element.content
    heartbeat.answer_stop()
    assert heartbeat._element.content == before.replace('stop-answers">0', 'stop-answers">1') != before
