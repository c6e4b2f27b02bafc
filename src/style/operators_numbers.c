/* Numbers as texts for readers: "number-format" with digits, a currency or a unit.
 *
 * Input: a number and options. Output: its text as in US English, whatever locale is asked for: commas between
 * thousands, a point before the fraction. It has the fewest digits that distinguish the number from others, and is
 * rounded if these are more than wanted. The table at the end has each operator's row. */
#include "style/evaluation.h"
#include "style/operators.h"
#include "style/text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- Digits ---- */

enum { FRACTION_MAX = 100, DIGITS_MAX = 40, TEXT_MAX = 640 };

/* The number 0.ddd * 10^point. The digits have no zeros at their end. */
typedef struct decimal {
    char digits[DIGITS_MAX];
    int count, point;
} decimal;

/* Reads the text of a number that camber_number_format wrote. */
static decimal read_decimal(double magnitude) {
    char text[CAMBER_NUMBER_TEXT_SIZE];
    decimal made = {.point = -1};
    camber_number_format(magnitude, text);
    int before = 0;
    bool fraction = false;
    const char *c = text;
    for (; *c && *c != 'e'; c++) {
        fraction |= *c == '.';
        if (*c == '.')
            continue;
        before += !fraction;
        made.digits[made.count++] = *c;
    }
    made.point = before + (*c == 'e' ? (int)strtol(c + 1, NULL, 10) : 0);
    return made;
}

/* Rounds to `fraction` digits after the point, and halves away from 0. */
static void round_decimal(decimal *d, int fraction) {
    const int kept = d->point + fraction;
    if (kept >= d->count)
        return;
    const bool up = kept >= 0 && d->digits[kept] >= '5';
    d->count = kept > 0 ? kept : 0;
    if (!up)
        return;
    int i = d->count - 1;
    while (i >= 0 && d->digits[i] == '9')
        d->digits[i--] = '0';
    if (i >= 0) {
        d->digits[i]++;
        return;
    }
    memmove(d->digits + 1, d->digits, (size_t)d->count);
    d->digits[0] = '1';
    d->count++;
    d->point++;
}

static char digit_at(const decimal *d, int place) {
    return place >= 0 && place < d->count ? d->digits[place] : '0';
}

/* Writes a magnitude with at least `least` and at most `most` digits after the point. */
static void write_magnitude(double magnitude, int least, int most, char text[TEXT_MAX]) {
    decimal d = read_decimal(magnitude);
    char *at = text;
    round_decimal(&d, most);
    const int whole = d.point > 0 ? d.point : 1;
    for (int i = 0; i < whole; i++) {
        if (i > 0 && (whole - i) % 3 == 0)
            *at++ = ',';
        *at++ = d.point > 0 ? digit_at(&d, i) : '0';
    }
    int shown = d.count - d.point;
    while (shown > least && digit_at(&d, d.point + shown - 1) == '0')
        shown--;
    shown = shown < least ? least : shown;
    if (shown > 0)
        *at++ = '.';
    for (int i = 0; i < shown; i++)
        *at++ = digit_at(&d, d.point + i);
    *at = 0;
}

/* ---- Currencies and units ---- */

typedef struct currency {
    const char *code, *sign;
    int digits;
} currency;

/* Other currencies are written as their code and a no-break space, with two digits after the point. */
static const currency currencies[] = {
    {"USD", "$", 2},
    {"EUR", "\xe2\x82\xac", 2},
    {"GBP", "\xc2\xa3", 2},
    {"JPY", "\xc2\xa5", 0},
    {"CNY", "CN\xc2\xa5", 2},
    {"INR", "\xe2\x82\xb9", 2},
    {"KRW", "\xe2\x82\xa9", 0},
    {"CAD", "CA$", 2},
    {"AUD", "A$", 2},
    {"NZD", "NZ$", 2},
    {"MXN", "MX$", 2},
    {"BRL", "R$", 2},
    {"HKD", "HK$", 2},
    {"TWD", "NT$", 2},
    {"ILS", "\xe2\x82\xaa", 2},
    {"VND", "\xe2\x82\xab", 0},
    {"PHP", "\xe2\x82\xb1", 2},
    {"XAF", "FCFA\xc2\xa0", 0},
    {"XOF",
     "F\xe2\x80\xaf"
     "CFA\xc2\xa0",
     0},
    {"CLP", "CLP\xc2\xa0", 0},
    {"ISK", "ISK\xc2\xa0", 0},
    {"KWD", "KWD\xc2\xa0", 3},
};

typedef struct unit {
    const char *name, *one, *many; /* written after the number */
} unit;

static const unit units[] = {
    {"acre", " ac", " ac"},
    {"bit", " bit", " bit"},
    {"byte", " byte", " byte"},
    {"celsius",
     "\xc2\xb0"
     "C",
     "\xc2\xb0"
     "C"},
    {"centimeter", " cm", " cm"},
    {"day", " day", " days"},
    {"degree", " deg", " deg"},
    {"fahrenheit",
     "\xc2\xb0"
     "F",
     "\xc2\xb0"
     "F"},
    {"fluid-ounce", " fl oz", " fl oz"},
    {"foot", " ft", " ft"},
    {"gallon", " gal", " gal"},
    {"gigabit", " Gb", " Gb"},
    {"gigabyte", " GB", " GB"},
    {"gram", " g", " g"},
    {"hectare", " ha", " ha"},
    {"hour", " hr", " hr"},
    {"inch", " in", " in"},
    {"kilobit", " kb", " kb"},
    {"kilobyte", " kB", " kB"},
    {"kilogram", " kg", " kg"},
    {"kilometer", " km", " km"},
    {"kilometer-per-hour", " km/h", " km/h"},
    {"liter", " L", " L"},
    {"megabit", " Mb", " Mb"},
    {"megabyte", " MB", " MB"},
    {"meter", " m", " m"},
    {"meter-per-second", " m/s", " m/s"},
    {"mile", " mi", " mi"},
    {"mile-per-hour", " mph", " mph"},
    {"mile-scandinavian", " smi", " smi"},
    {"milliliter", " mL", " mL"},
    {"millimeter", " mm", " mm"},
    {"millisecond", " ms", " ms"},
    {"minute", " min", " min"},
    {"month", " mth", " mths"},
    {"ounce", " oz", " oz"},
    {"percent", "%", "%"},
    {"petabyte", " PB", " PB"},
    {"pound", " lb", " lb"},
    {"second", " sec", " sec"},
    {"stone", " st", " st"},
    {"terabit", " Tb", " Tb"},
    {"terabyte", " TB", " TB"},
    {"week", " wk", " wks"},
    {"yard", " yd", " yd"},
    {"year", " yr", " yrs"},
};

static currency find_currency(const char *code, char room[16]) {
    for (size_t i = 0; i < sizeof currencies / sizeof *currencies; i++)
        if (strcmp(currencies[i].code, code) == 0)
            return currencies[i];
    snprintf(room, 16, "%.3s\xc2\xa0", code);
    return (currency){code, room, 2};
}

static const unit *find_unit(const char *name) {
    for (size_t i = 0; i < sizeof units / sizeof *units; i++)
        if (strcmp(units[i].name, name) == 0)
            return units + i;
    return NULL;
}

/* ---- When evaluated ---- */

/* The operands. */
enum { FORMAT_NUMBER, FORMAT_LOCALE, FORMAT_CURRENCY, FORMAT_UNIT, FORMAT_LEAST, FORMAT_MOST };

/* Reads a number of digits. *digits is unchanged if the option is not given. */
static bool read_digits(camber_evaluation *e, const camber_node *node, uint32_t operand, bool *given, int *digits) {
    camber_value value;
    if (!camber_evaluate_operand(e, node, operand, &value))
        return false;
    *given = value.type == CAMBER_VALUE_NUMBER;
    if (!*given)
        return true;
    if (!(value.number >= 0.0 && value.number <= FRACTION_MAX))
        return camber_evaluate_fail(e, "the digits of a fraction are 0 to 100");
    *digits = (int)value.number;
    return true;
}

/* Reads both bounds of the digits after the point. If only one is given, the other is moved to it if necessary. */
static bool read_fraction(camber_evaluation *e, const camber_node *node, int *least, int *most) {
    bool has_least, has_most;
    if (!read_digits(e, node, FORMAT_LEAST, &has_least, least) || !read_digits(e, node, FORMAT_MOST, &has_most, most))
        return false;
    if (has_least && has_most && *least > *most)
        return camber_evaluate_fail(e, "min-fraction-digits is above max-fraction-digits");
    if (has_most && *least > *most)
        *least = *most;
    if (has_least && *most < *least)
        *most = *least;
    return true;
}

static bool evaluate_number_format(camber_evaluation *e, const camber_node *node, camber_value *value) {
    double number;
    camber_value code, name;
    char room[16], magnitude[TEXT_MAX] = "NaN", text[TEXT_MAX + 64];
    if (!camber_evaluate_number(e, node, FORMAT_NUMBER, &number) ||
        !camber_evaluate_operand(e, node, FORMAT_CURRENCY, &code) ||
        !camber_evaluate_operand(e, node, FORMAT_UNIT, &name))
        return false;
    const bool is_money = code.type == CAMBER_VALUE_STRING;
    if (is_money && strlen(code.string) != 3)
        return camber_evaluate_fail(e, "a currency is named by three letters, such as \"EUR\"");
    const currency money = is_money ? find_currency(code.string, room) : (currency){"", "", 0};
    const unit *of = name.type == CAMBER_VALUE_STRING ? find_unit(name.string) : NULL;
    if (name.type == CAMBER_VALUE_STRING && !of)
        return camber_evaluate_fail(e, "the unit is not known; use one such as \"meter\" or \"kilometer-per-hour\"");
    int least = money.digits, most = is_money ? money.digits : 3;
    if (!read_fraction(e, node, &least, &most))
        return false;
    if (isfinite(number))
        write_magnitude(fabs(number), least, most, magnitude);
    else if (!isnan(number))
        snprintf(magnitude, sizeof magnitude, "\xe2\x88\x9e");
    const char *behind = !of ? "" : strcmp(magnitude, "1") == 0 ? of->one : of->many;
    const int length = snprintf(text, sizeof text, "%s%s%s%s", signbit(number) && !isnan(number) ? "-" : "", money.sign,
                                magnitude, behind);
    camber_string made = {.e = e};
    return camber_string_add(&made, text, (size_t)length) && camber_string_end(&made, value);
}

/* ---- When compiled ---- */

static bool push_option(camber_compiler *c, json_t *option, const char *name, camber_type type) {
    static const camber_value nothing = {.type = CAMBER_VALUE_NULL};
    uint32_t node = 0;
    if (!option)
        return camber_make_constant(c, &nothing, camber_typing_of(CAMBER_TYPE_NULL), &node) &&
               camber_push_operand(c, node);
    camber_compiler_enter_key(c, name);
    if (!camber_compile(c, option, camber_typing_of(type), &node) || !camber_push_operand(c, node))
        return false;
    camber_compiler_leave(c);
    return true;
}

/* Compiles ["number-format", number, {"locale": ..., "currency": ..., "unit": ..., "min-fraction-digits": ..., ...}].
 */
static bool compile_number_format(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                                  uint32_t *node) {
    static const struct {
        const char *name;
        camber_type type;
    } options[] = {{"locale", STRING},
                   {"currency", STRING},
                   {"unit", STRING},
                   {"min-fraction-digits", NUMBER},
                   {"max-fraction-digits", NUMBER}};
    (void)expected;
    const size_t first_operand = c->operand_count;
    const json_t *given = json_array_get(array, 2);
    if (!camber_compile_operand(c, array, 1, camber_typing_of(NUMBER)))
        return false;
    camber_compiler_enter_index(c, 2);
    if (!json_is_object(given))
        return camber_compiler_fail(c, "expected an object, found %s; write {\"max-fraction-digits\": 1}",
                                    camber_json_name(given));
    if (json_object_get(given, "currency") && json_object_get(given, "unit"))
        return camber_compiler_fail(c, "a number has a currency or a unit; leave one of them out");
    for (size_t i = 0; i < sizeof options / sizeof *options; i++)
        if (!push_option(c, json_object_get(given, options[i].name), options[i].name, options[i].type))
            return false;
    camber_compiler_leave(c);
    return camber_make_node(c, &(camber_node){.evaluate = row->evaluate, .type = camber_typing_of(row->result)},
                            first_operand, node);
}

static const camber_operator rows[] = {
    {"number-format", compile_number_format, evaluate_number_format, NUMBER, STRING, 2, 2},
};

const camber_operator_table camber_number_operators = {rows, sizeof rows / sizeof *rows};
