"""Style sheets for what viser has no options for. They find viser's elements around or after an empty marker.

In windows that are narrower than PHONE, viser shows all panels in a sheet at the bottom. There, STOP is fixed at the top of the window,
and the scene fills what is left. A tap on the title of the sheet would close it, and disable STOP: it does nothing where there is STOP.
"""

PHONE = "@media (max-width: 36em)"
STOP_HEIGHT, SHEET_HEIGHT = "6.5em", "50%"  # on a phone
OPEN = ':root:not(:has([style*="display: none"] .page-style))'  # the sheet
SHEET_TITLE = '.mantine-Paper-root [style*="width: 20em"]:has(.stop-style) > div:first-child'
SCENE = ".mantine-Notifications-root ~ div:not(.mantine-Paper-root):has(canvas)"

STOP_BUTTON = "div:has(> .stop-style) + div button"
JOG_BUTTONS = "div:has(> .two-columns) ~ div > button"

PANEL_WIDTH = 400  # pixels; the six tabs of a robot fit into one row
BANNERS = "banners"  # the class of an element with a child for each

# Notifications are at the top left of the scene, STOP at its bottom right. Banners lie over the scene: above the tabs, they would move the
# buttons under the pointer.
PAGE = f"""<style>
.mantine-Notifications-root {{max-height: calc(100% - 14em); overflow: hidden}}
.{BANNERS} {{position: fixed; z-index: 300; top: 10px; right: {PANEL_WIDTH + 20}px; width: 26em;
  max-width: calc(100vw - {PANEL_WIDTH + 40}px); pointer-events: none}}
.{BANNERS} > div {{color: white; font-weight: 600; padding: 10px 14px; border-radius: 6px; margin-bottom: 6px}}
{PHONE} {{
  .{BANNERS} {{top: calc({STOP_HEIGHT} + 6px); left: 6px; right: 6px; width: auto; max-width: none}}
  [style*="width: 20em"]:has(.page-style) {{width: 100vw !important}}
  [style*="max-height: 60%"]:has(.page-style) {{max-height: {SHEET_HEIGHT} !important}}
  {OPEN} [style*="max-height: 60%"]:has(.page-style) {{min-height: {SHEET_HEIGHT} !important}}
  {OPEN} {SCENE} {{height: calc(100% - {SHEET_HEIGHT}) !important}}
  .mantine-Notifications-root {{max-height: calc(100% - {SHEET_HEIGHT} - {STOP_HEIGHT} - 2em)}}
}}
</style><div class="page-style"></div>"""

# The button after this element, and on a phone all elements of its panel.
STOP = f"""<style>
{STOP_BUTTON} {{height: 72px !important; font-size: 30px; font-weight: 700; touch-action: none}}
{PHONE} {{
  div:has(> div > .stop-style) {{position: fixed; top: 0; left: 0; right: 0; height: {STOP_HEIGHT}; box-sizing: border-box;
                                 padding-top: 0.5em; background: var(--mantine-color-body)}}
  {STOP_BUTTON} {{height: 52px !important}}
  {SHEET_TITLE} {{pointer-events: none}}
  {SHEET_TITLE} button {{pointer-events: auto}}
  .mantine-Tabs-root:has(.stop-style) > [role=button] {{display: none !important}}
  {SCENE} {{box-sizing: border-box; padding-top: {STOP_HEIGHT}}}
  .mantine-Notifications-root {{top: calc({STOP_HEIGHT} + 1em) !important}}
}}
</style><div class="stop-style"></div>"""

# The buttons after this element. A finger that moves on one of them neither scrolls nor zooms the page, which would end its touch.
TWO_COLUMNS = f"""<style>
div:has(> .two-columns) ~ div:has(> button) {{display: inline-block; width: calc(50% - 2 * var(--mantine-spacing-xs))}}
{JOG_BUTTONS} {{touch-action: none; -webkit-touch-callout: none}}
</style><div class="two-columns"></div>"""
