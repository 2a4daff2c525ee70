"""Scripts of the page. viser does not run scripts in its HTML, but event handlers: that of an image without content."""

import html

from . import style


def script(name: str, code: str) -> str:
    """Returns HTML that runs `code` when it is shown for the first time. `name`: of a variable of the page."""
    return ('<img src="data:," alt="" style="display: none" onerror="'
            f'{html.escape(f"if (!window.{name}) {{ window.{name} = true; {code} }}")}">')


# showNotice(name, text) shows a text over the page; one that is empty hides it. Clicks pass through notices: none disables a button.
NOTICES = script("hasNotices", """
window.showNotice = (name, text) => {
  let all = document.getElementById('notices');
  if (!all) {
    all = document.createElement('div');
    all.id = 'notices';
    all.style.cssText = 'position: fixed; top: 35%; left: 0; right: 0; z-index: 100000; pointer-events: none; color: white;' +
        'font: 600 20px sans-serif; text-align: center';
    document.body.append(all);
  }
  let notice = document.getElementById('notice-' + name);
  if (!notice) {
    notice = document.createElement('div');
    notice.id = 'notice-' + name;
    notice.role = 'alert';
    notice.style.cssText = 'background: #c62828; padding: 16px; margin: 8px';
    all.append(notice);
  }
  if (notice.textContent !== text) notice.textContent = text;
  notice.style.display = text ? '' : 'none';
}
""")

# isStopPress(event) tells whether viser executes STOP for an event. In an input, a copy of Esc is dispatched outside of it.
STOP_PRESSES = script("hasStopPresses", f"""
window.isStopPress = event => event.type === 'keydown' ?
    event.key === 'Escape' && !event.ctrlKey && !event.altKey && !event.shiftKey && !event.metaKey :
    event.button === 0 && Boolean(event.target.closest?.('{style.STOP_BUTTON}'));
""")
