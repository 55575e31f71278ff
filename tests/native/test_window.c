/* test_window.c: the window of the glfw backend: what is presented is what it shows; other backends have none. */
#include "check.h"

static const uint8_t picture[] = {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 10, 20, 30, 255};

static void test_refusals(const char *reason) {
    hn_event event;
    int width, height;
    CHECK_FAILS(hn_window_show("t", 1, 1) == -1, reason);
    CHECK_FAILS(hn_window_title("t") == -1, reason);
    CHECK_FAILS(hn_window_events(&event, 1, 0) == -1, reason);
    CHECK_FAILS(hn_window_present(NULL) == -1, reason);
    CHECK_FAILS(hn_window_present_bytes(2, 2, picture) == -1, reason);
    CHECK_FAILS(hn_window_read(&width, &height, NULL, 0) == -1, reason);
    CHECK_FAILS(hn_window_swap() == -1, reason);
}

static void test_arguments(void) {
    hn_event event;
    CHECK_FAILS(hn_window_show(NULL, 8, 8) == -1, "no title");
    CHECK_FAILS(hn_window_show("t", 0, 8) == -1, "0 x 8 pixels");
    CHECK_FAILS(hn_window_title(NULL) == -1, "no title");
    CHECK_FAILS(hn_window_events(NULL, 1, 0) == -1, "nowhere to put the events");
    CHECK_FAILS(hn_window_events(&event, 0, 0) == -1, "nowhere to put the events");
    CHECK_FAILS(hn_window_present(NULL) == -1, "no target");
    CHECK_FAILS(hn_window_present_bytes(1, 1, NULL) == -1, "no pixels");
    CHECK_FAILS(hn_window_read(NULL, NULL, NULL, 0) == -1, "nowhere to put the size");
}

/* Bytes come back as they are, enlarged over the window; colours of a target clamped and rounded. */
static void test_shows(void) {
    int width = 0, height = 0;
    static uint8_t shown[64 * 48 * 4];
    CHECK(hn_window_show("test", 64, 48) == 0 && hn_window_title("test \xC3\xA4") == 0);
    CHECK(hn_window_read(&width, &height, NULL, 0) == 0 && width == 64 && height == 48);
    CHECK_FAILS(hn_window_read(&width, &height, shown, 1) == -1, "do not fit");
    CHECK(hn_window_present_bytes(2, 2, picture) == 0);
    CHECK(hn_window_read(&width, &height, shown, sizeof shown) == 0);
    CHECK(memcmp(shown, picture, 4) == 0 && memcmp(shown + 4 * 63, picture + 4, 4) == 0);
    CHECK(memcmp(shown + 4 * 64 * 47, picture + 8, 4) == 0);
    CHECK(memcmp(shown + sizeof shown - 4, picture + 12, 4) == 0);
    CHECK(hn_window_swap() == 0);

    const float rgba[4] = {-0.5f, 0.5f, 2, 0.25f};
    hn_target *target = hn_target_create(64, 48, GL_RGB32F);
    CHECK(clear(target, rgba) == 0 && hn_window_present(target) == 0);
    CHECK(hn_window_read(&width, &height, shown, sizeof shown) == 0);
    const uint8_t expected[4] = {0, 128, 255, 255};
    int right = 1;
    for (size_t i = 0; i < sizeof shown; ++i)
        right = right && shown[i] == expected[i % 4];
    CHECK(right);
    CHECK(hn_window_swap() == 0);
    hn_target_delete(target);
    hn_event events[64];
    CHECK(hn_window_events(events, 64, 0.01) >= 0);
}

void test_window(int has_window) {
    if (!has_window) {
        test_refusals("only the backend glfw has a window");
        return;
    }
    test_arguments();
    test_shows();
    hn_context_close();
    test_refusals("no context: call hn_context_open() first");
    CHECK(hn_context_open() == 0);
}
