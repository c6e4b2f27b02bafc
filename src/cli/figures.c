#include "cli/figures.h"

#include <stdio.h>

camber_figure camber_figure_number(double value, int decimals) {
    char digits[40];
    camber_figure figure;
    const int size = snprintf(digits, sizeof digits, "%.*f", decimals, value < 1e15 && value > -1e15 ? value : 0.0);
    const int whole = decimals ? size - decimals - 1 : size, first = digits[0] == '-';
    int used = 0;
    for (int i = 0; i < size; i++) {
        if (i > first && i < whole && (whole - i) % 3 == 0)
            figure.text[used++] = ',';
        figure.text[used++] = digits[i];
    }
    figure.text[used] = 0;
    return figure;
}

camber_figure camber_figure_count(uint64_t count) {
    return camber_figure_number((double)count, 0);
}

camber_figure camber_figure_bytes(uint64_t size_bytes) {
    static const char *const units[] = {"KB", "MB", "GB", "TB"};
    camber_figure figure;
    double size = (double)size_bytes / 1e3;
    int unit = 0;
    if (size_bytes < 1000) {
        snprintf(figure.text, sizeof figure.text, "%d byte%s", (int)size_bytes, size_bytes == 1 ? "" : "s");
        return figure;
    }
    for (; size >= 999.5 && unit < 3; unit++)
        size /= 1e3;
    snprintf(figure.text, sizeof figure.text, "%.24s %s", camber_figure_number(size, size < 99.95 ? 1 : 0).text,
             units[unit]);
    return figure;
}

camber_figure camber_figure_limit(uint64_t size_bytes) {
    camber_figure figure;
    uint64_t size = size_bytes;
    int unit = -1;
    while (unit < 2 && size && size % 1024 == 0) {
        size /= 1024;
        unit++;
    }
    if (unit < 0 || size > 9999)
        return camber_figure_bytes(size_bytes);
    snprintf(figure.text, sizeof figure.text, "%d%c", (int)size, "KMG"[unit]);
    return figure;
}

camber_figure camber_figure_time(double ms) {
    camber_figure figure;
    const double s = ms > 0 && ms < 1e12 ? ms / 1e3 : 0.0;
    const int whole = (int)(s + 0.5), minutes = whole / 60;
    if (s < 9.995)
        snprintf(figure.text, sizeof figure.text, "%.2f s", s);
    else if (whole < 60)
        snprintf(figure.text, sizeof figure.text, "%.1f s", s < 59.94 ? s : 59.9);
    else if (minutes < 60)
        snprintf(figure.text, sizeof figure.text, "%d min %d s", minutes, whole % 60);
    else
        snprintf(figure.text, sizeof figure.text, "%.24s h %d min", camber_figure_count((uint64_t)(minutes / 60)).text,
                 minutes % 60);
    return figure;
}
