/* tiles FILE PORT: draws tiles of a map in a program that has its own HTTP server: http://127.0.0.1:PORT/z/x/y.png */
#include <arpa/inet.h>
#include <camber_tiles.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>

typedef struct map {
    camber_tiles_engine *engine;
    camber_encoder *encoder;
    uint8_t *rgba; /* memory for one picture of the engine */
} map;

static void print_message(void *user, camber_log_level level, const char *message) {
    if (level < CAMBER_LOG_INFO)
        fprintf(user, "tiles: %s\n", message);
}

/* Draws one tile and encodes it. The bytes belong to the encoder and are valid until its next call. */
static bool draw(map *m, int zoom, uint32_t column, uint32_t row, const uint8_t **bytes, size_t *size_bytes) {
    camber_tiles_picture picture;
    camber_pixels pixels;
    if (camber_tiles_engine_draw(m->engine, zoom, column, row, m->rgba, &picture) != CAMBER_OK)
        return false;
    camber_tiles_picture_get_tile(&picture, column - picture.column, row - picture.row, &pixels);
    return camber_encoder_encode(m->encoder, &pixels, bytes, size_bytes) == CAMBER_OK;
}

/* Reads the whole head of a request, because closing a connection with unread data resets it. */
static void read_head(int connection, char *head, size_t room_bytes) {
    ssize_t got;
    for (size_t at = 0; !strstr(head, "\r\n\r\n"); at += (size_t)got)
        if ((got = recv(connection, head + at, room_bytes - 1 - at, 0)) <= 0)
            return;
}

/* Replace this by your own server's handler of a request. */
static void answer(map *m, int connection) {
    int zoom;
    unsigned column, row;
    const uint8_t *bytes;
    size_t size_bytes;
    char request[4096] = "";
    FILE *client = fdopen(connection, "w");
    read_head(connection, request, sizeof request);
    if (sscanf(request, "GET /%2d/%8u/%8u.png ", &zoom, &column, &row) == 3 &&
        draw(m, zoom, column, row, &bytes, &size_bytes)) {
        fprintf(client, "HTTP/1.0 200 OK\r\nContent-Type: image/png\r\nContent-Length: %zu\r\n\r\n", size_bytes);
        fwrite(bytes, 1, size_bytes, client);
    } else {
        fputs("HTTP/1.0 404 Not Found\r\nContent-Length: 0\r\n\r\n", client);
    }
    fclose(client);
}

static int listen_at(const char *port) {
    struct sockaddr_in here = {.sin_family = AF_INET, .sin_port = htons((uint16_t)atoi(port))};
    const int on = 1, made = socket(AF_INET, SOCK_STREAM, 0);
    here.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    (void)setsockopt(made, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    return bind(made, (struct sockaddr *)&here, sizeof here) == 0 && listen(made, 16) == 0 ? made : -1;
}

int main(int argc, char **argv) {
    const camber_context_desc log = {.log = print_message, .log_user = stderr};
    const camber_source_desc source = {.path = argc > 2 ? argv[1] : "map.geojson"};
    camber_tiles_engine_desc desc = {.simplify_px = 0.1, .on_demand_side = 1};
    camber_context *context = NULL;
    camber_style *style = NULL;
    camber_features *features = NULL;
    map m = {0};
    if (camber_context_create(&log, &context) != CAMBER_OK ||
        camber_style_create_builtin(context, CAMBER_THEME_LIGHT, &style) != CAMBER_OK ||
        camber_features_create(context, style, &features) != CAMBER_OK ||
        camber_features_read(features, &source) != CAMBER_OK ||
        camber_device_create(context, NULL, &desc.device) != CAMBER_OK ||
        camber_renderer_create(desc.device, NULL, NULL, &desc.renderer) != CAMBER_OK ||
        camber_tiles_engine_create(features, &desc, &m.engine) != CAMBER_OK ||
        camber_encoder_create(context, &(camber_encoder_desc){.encoding = CAMBER_ENCODING_PNG}, &m.encoder) !=
            CAMBER_OK ||
        !(m.rgba = malloc(camber_tiles_engine_get_picture_bytes(m.engine))))
        return 1;
    const char *port = argc > 2 ? argv[2] : "8080";
    const int listening = listen_at(port);
    for (int client; listening >= 0 && (client = accept(listening, NULL, NULL)) >= 0;)
        answer(&m, client);
    fprintf(stderr, "tiles: port %s: %s\n", port, strerror(errno)); /* most likely it is in use */
    return 1;
}
