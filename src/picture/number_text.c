/* number_text.c - numbers as markup. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "picture/plot.h"

NumberText format_digits(double value, int digits)
{
    NumberText out;
    size_t size = sizeof out.text;
    char plain[26];
    const char *sign = value < 0 ? "\u2212" : "";
    double most = fabs(value), large = fmax(1e5, pow(10, digits) - 0.5);
    snprintf(plain, sizeof plain, "%.*e", digits - 1, most);
    if (!isfinite(value)) {
        snprintf(out.text, size, "%s%s", sign,
                 isnan(value) ? "no number" : "\u221e");
    } else if (most == 0 || (most >= 1e-3 && most < large)) {
        snprintf(out.text, size, "%s%.15g", sign, strtod(plain, NULL));
    } else {
        char *power = strchr(plain, 'e');
        int exponent = (int)strtol(power + 1, NULL, 10);
        *power = '\0';
        double part = strtod(plain, NULL);
        snprintf(plain, sizeof plain, "%.15g\u00b7", part);
        snprintf(out.text, size, "%s%s10^{%s%d}", sign, part == 1 ? "" : plain,
                 exponent < 0 ? "\u2212" : "", abs(exponent));
    }
    return out;
}

NumberText format_number(double value)
{
    return format_digits(value, 3);
}

NumberText format_power(const char *value)
{
    char *rest;
    double number = strtod(value, &rest);
    const char *power = strchr(value, 'e');
    NumberText out;
    if (power && power < rest && *rest != '_')
        snprintf(out.text, sizeof out.text, "%.30s%.16s",
                 format_digits(number, 6).text, rest);
    else
        snprintf(out.text, sizeof out.text, "%.47s", value);
    return out;
}
