// A cosine to a power.

// log(1 - x), which keeps its digits where x is small.
float log_of_rest(float x)
{
    float y = x / (2.0 - x), y2 = y * y;
    return x < 0.1 ? -2.0 * y * (1.0 + y2 * (1.0 / 3.0 + y2 * (0.2 + y2 / 7.0))) : log(1.0 - x);
}

float power(float cosine, float sine2, float exponent)
{
    if (cosine <= 0.0)
        return 0.0;
    return exp(exponent * (sine2 < 0.5 ? 0.5 * log_of_rest(sine2) : log(cosine)));
}
