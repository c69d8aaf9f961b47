#!/usr/bin/env perl
# comments.pl: comments and names that a stranger is likely to stumble over.
# A machine cannot tell a good comment; these signs of a bad one it can:
#   leans     a comment beside code begins with a pronoun or a small word, or
#             ends with a comma: it needs its neighbour
#   subject   a sentence begins with a pronoun
#   twins     two files define functions of one name
# Without arguments, lists all finds.  With limits (leans=N subject=N twins=N),
# prints a line for each kind that has more finds than its limit.  The limits are
# the lowest counts so far: lower them, never raise them.
use strict;
use warnings;

my %limit = (leans => 0, subject => 0, twins => 0);
my $limits = shift // '';
$limit{$1} = $2 while $limits =~ /(\w+)=(\d+)/g;

my $small = qr/(?:its?|and|or|but|that|those|these|this|they|them|what|whom?|
    whose|which|where|ones?|the\ same|so|such|else|of|(?:in|with)\ which|here|
    there|then|both|all|none|nothing|each\ of|another|others?)\b/xi;
my %found;
my %homes;
for my $file (glob('src/*/*.[ch] src/main.c include/*/*.h')) {
    open my $in, '<', $file or die "$file: $!\n";
    my $text = do { local $/; <$in> };
    while ($text =~ m{/\*(.*?)\*/}sg) {
        my ($body, $start) = ($1, $-[0]);
        my $line = 1 + (substr($text, 0, $start) =~ tr/\n//);
        my ($before) = substr($text, 0, $start) =~ /([^\n]*)\z/;
        $body =~ s/^[ \t]*\*?[ \t]*//mg;
        $body =~ s/\s+/ /g;
        $body =~ s/^ | $//g;
        next if $body =~ /^[-=]{3}|clang-format/;
        if ($before =~ /\S/) {
            push @{ $found{leans} }, "$file:$line: $body"
                if $body =~ /^$small|,$/;
        } elsif (grep { length > 12 && /^$small/ && !/^(?:where|else|then|so that)/i }
            split /(?<=[.;:]) /, $body) {
            push @{ $found{subject} }, "$file:$line: $body";
        }
    }
    next if $file !~ /\.c$/;
    $homes{$1}{$file} = 1
        while $text =~ /^(?:\w[\w ]*[ *])(\w+)\((?:[^;{}()]|\([^()]*\))*\)\s*\{/mg;
}
for my $name (sort keys %homes) {
    my @files = sort keys %{ $homes{$name} };
    push @{ $found{twins} }, "$name: @files" if @files > 1;
}
for my $kind (sort keys %limit) {
    my @finds = @{ $found{$kind} // [] };
    next if @finds <= $limit{$kind};
    print scalar(@finds), " $kind, ", $limits
        ? "at most $limit{$kind} are allowed; tests/checks/comments.pl lists them\n"
        : join("\n  ", 'finds:', @finds) . "\n";
}
