/* number_text.c - numbers as markup. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "picture/plot.h"

NumberText format_digits(double value, int digits)
{
    NumberText out;
    size_t size = sizeof out.text;
    char plain[26];
    const char *sign = value < 0 ? "\u2212" : "";
    double most = fabs(value), longer = pow(10, digits) - 0.5;
    snprintf(plain, sizeof plain, "%.*e", digits - 1, value);
    if (!isfinite(value))
        snprintf(out.text, size, "%s%s", sign,
                 isnan(value) ? "no number" : "\u221e");
    else if (most != 0 && (most < 1e-3 || most >= fmax(1e5, longer)))
        out = format_power_of_ten(plain);
    else if (most < longer)
        snprintf(out.text, size, "%s%.*g", sign, digits, most);
    else { /* zeros take the place of the digits that are left out */
        double unit = pow(10, floor(log10(most)) + 1 - digits);
        snprintf(out.text, size, "%s%.0f", sign, rint(most / unit) * unit);
    }
    return out;
}

NumberText format_number(double value)
{
    return format_digits(value, 3);
}

NumberText format_power_of_ten(const char *value)
{
    NumberText out;
    const char *digit = value + (value[0] == '-');
    int length = (int)strspn(digit, "0123456789."), digits = length;
    const char *power = digit + length, *rest = power;
    bool point = memchr(digit, '.', (size_t)length);
    if (length > 0 && *power == 'e') {
        power += 1 + strspn(power + 1, "+-0");
        rest = power + strspn(power, "0123456789");
    }
    if (rest == power || *rest == '_') {
        snprintf(out.text, sizeof out.text, "%.47s", value);
        return out;
    }
    while (point && digits > 1 && strchr("0.", digit[digits - 1]))
        point = digit[--digits] != '.';
    bool one = digits == 1 && *digit == '1'; /* 10^{6}, not 1*10^{6} */
    snprintf(out.text, sizeof out.text, "%s%.*s%s10^{%s%.*s}%.16s",
             digit > value ? "\u2212" : "", one ? 0 : digits, digit,
             one ? "" : "\u00b7", digit[length + 1] == '-' ? "\u2212" : "",
             (int)(rest - power), power, rest);
    return out;
}
